#include "io/formats/epw.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "solver/model/error.h"
#include "tests/io/weather_text.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

class Epw : public ::testing::Test {
 protected:
  Weather read(const std::vector<std::string>& lines) { return read_epw(folder_.write("city.epw", joined(lines))); }
  std::string refused(const std::vector<std::string>& lines) { return refused_text(joined(lines)); }
  std::string refused_text(const std::string& content) {
    try {
      read_epw(folder_.write("city.epw", content));
      return "(it was read)";
    } catch (const InputError& error) {
      return error.what();
    }
  }
  /// The day with one cell of one line replaced.
  static std::vector<std::string> with_cell(std::size_t line, std::size_t column, const std::string& value) {
    std::vector<std::string> lines = weather_lines();
    std::string& row = lines[line - 1];
    std::size_t begin = 0;
    for (; column > 0; --column) begin = row.find(',', begin) + 1;
    row.replace(begin, std::min(row.find(',', begin), row.size()) - begin, value);
    return lines;
  }

  TempFolder folder_;
};

TEST_F(Epw, HoldsPlaceAndHoursAndKnowsWhatIsMissing) {
  const Weather weather = read(weather_lines());
  EXPECT_EQ(weather.city, "Golden");
  EXPECT_EQ(weather.place.latitude_deg, 39.742476);
  EXPECT_EQ(weather.place.longitude_deg, -105.1786);
  EXPECT_EQ(weather.place.timezone, -7);
  ASSERT_EQ(weather.hours.size(), 24u);
  const WeatherHour& noon = weather.at(10, 17, 13);
  EXPECT_EQ(noon.line, 21);
  EXPECT_EQ(noon.direct_normal, 600);
  EXPECT_EQ(noon.diffuse_horizontal, 120);
  EXPECT_EQ(noon.direct_normal_lux, 62000);
  EXPECT_EQ(noon.diffuse_horizontal_lux, 16000);
  EXPECT_EQ(noon.dew_point_c, 2);
  EXPECT_EQ(noon.precipitable_water_cm, 1.2);
  EXPECT_FALSE(weather.at(10, 17, 12).direct_normal_lux);
  EXPECT_FALSE(weather.at(10, 17, 15).direct_normal);
  EXPECT_FALSE(read(with_cell(21, 7, "99.9")).at(10, 17, 13).dew_point_c);
}

TEST_F(Epw, IsReadWithWindowsLineEndsAndAByteOrderMark) {
  std::string content = "\xef\xbb\xbf";
  for (const std::string& line : weather_lines()) content += line + "\r\n";
  EXPECT_EQ(read_epw(folder_.write("city.epw", content)).hours.size(), 24u);
}

TEST_F(Epw, RefusalsNameLineAndReason) {
  EXPECT_EQ(refused(with_cell(1, 0, "hello")),
            "city.epw:1: begins with 'hello' and not with LOCATION; it is no EPW weather file. Name one");
  EXPECT_EQ(refused(with_cell(1, 6, "north")), "city.epw:1: the latitude = 'north' is not a number");
  EXPECT_EQ(refused(with_cell(1, 6, "91")), "city.epw:1: the latitude = 91 is outside [-90, 90]");
  EXPECT_EQ(refused(with_cell(1, 8, "nan")), "city.epw:1: the time zone = nan is outside [-14, 14]");
  EXPECT_EQ(refused(with_cell(8, 2, "4")), "city.epw:8: 4 records an hour; only hourly files are read");
  EXPECT_EQ(refused(with_cell(8, 0, "1995")),
            "city.epw:8: begins with '1995' and not with DATA PERIODS; the header has 8 lines. Download it again");
}

TEST_F(Epw, CommasBetweenQuotationMarksAndWithoutThemMoveNothing) {
  for (const char* city : {"\"Paris, Orly\"", "Paris, Orly", "\"Paris, Orly, \"\"South\"\"\"", "'Golden'"}) {
    const Weather weather = read(with_cell(1, 1, city));
    EXPECT_EQ(weather.place.latitude_deg, 39.742476) << city;
    EXPECT_EQ(weather.place.longitude_deg, -105.1786) << city;
    EXPECT_EQ(weather.place.timezone, -7) << city;
  }
  EXPECT_EQ(read(with_cell(1, 1, "\"Paris, Orly\"")).city, "Paris, Orly");
  std::vector<std::string> lines = weather_lines();
  lines[0] = "LOCATION,Golden,CO,USA,made up,0,39.742476,-105.1786,-7.0,1830.0,,,";  // as spreadsheets leave it
  EXPECT_EQ(read(lines).place.longitude_deg, -105.1786);
}

TEST_F(Epw, ASpreadsheetsSemicolonsAndDecimalCommasAreRead) {
  const std::string content = joined(weather_lines());
  for (const char separator : {';', '\t'}) {
    std::string changed = content;
    for (char& c : changed) c = c == ',' ? separator : c == '.' ? ',' : c;
    const Weather weather = read_epw(folder_.write("city.epw", changed));
    EXPECT_EQ(weather.place.latitude_deg, 39.742476);
    EXPECT_EQ(weather.at(10, 17, 13).direct_normal, 600);
    EXPECT_EQ(weather.at(10, 17, 13).dew_point_c, 2);
  }
}

TEST_F(Epw, DatesOfPeriodsOnlyTellWhetherTheFileIsCut) {
  for (const auto& [first, last] :
       {std::pair{"2003/10/17", "2003/10/17"}, {"10/17/2003", " 10/17/2003"}, {"2003-10-17", "2003-10-17"}}) {
    std::vector<std::string> lines = weather_lines();
    lines[7] = std::string("DATA PERIODS,1,1,Data,Friday,") + first + "," + last;
    EXPECT_EQ(read(lines).warnings.size(), 0u) << first;
    lines.pop_back();
    EXPECT_EQ(refused(lines), "city.epw: has 23 hours; its DATA PERIODS say 24. The file is cut short") << first;
  }
  const Weather weather = read(with_cell(8, 6, "10/32"));
  ASSERT_EQ(weather.warnings.size(), 1u);
  EXPECT_EQ(weather.warnings[0],
            "city.epw:8: '10/32' is not a date, month/day; whether the file is complete is not known");
}

TEST_F(Epw, ALeapDayMayBeThereOrNot) {
  std::vector<std::string> lines = weather_lines();
  const std::vector<std::string> day(lines.begin() + 8, lines.end());
  lines[7] = "DATA PERIODS,1,1,Data,Friday,2004/2/28,2004/3/1";
  lines.insert(lines.end(), day.begin(), day.end());
  EXPECT_EQ(read(lines).hours.size(), 48u);
  lines.insert(lines.end(), day.begin(), day.end());
  EXPECT_EQ(read(lines).hours.size(), 72u);
  lines.resize(8 + 47);
  EXPECT_EQ(refused(lines), "city.epw: has 47 hours; its DATA PERIODS say 48. The file is cut short");
}

TEST_F(Epw, HoursFrom0To23BeginThenAndAHour0AtTheEndIs24) {
  std::vector<std::string> lines = weather_lines();
  for (int hour = 1; hour <= 24; ++hour) {
    std::string& row = lines[static_cast<std::size_t>(7 + hour)];
    row.replace(0, row.find(",0,?9?9"), "2003,10,17," + std::to_string(hour - 1));
  }
  const Weather by_beginning = read(lines);
  EXPECT_EQ(by_beginning.at(10, 17, 13).direct_normal, 600);
  EXPECT_EQ(by_beginning.at(10, 17, 24).line, 32);
  ASSERT_EQ(by_beginning.warnings.size(), 1u);
  EXPECT_EQ(by_beginning.warnings[0], "city.epw: counts hours from 0; hour 0 is taken as the one from 0:00 to 1:00");

  lines = weather_lines();
  std::string& last = lines.back();
  last.replace(0, last.find(",0,?9?9"), "2003,10,18,0");
  EXPECT_EQ(read(lines).at(10, 17, 24).line, 32);
  EXPECT_EQ(read(lines).at(10, 17, 13).direct_normal, 600);
}

TEST_F(Epw, NightsOffsetsAreZeroAndFillersAreMissing) {
  EXPECT_EQ(read(with_cell(12, 14, "-5")).at(10, 17, 4).direct_normal, 0);
  EXPECT_EQ(read(with_cell(12, 14, "-0")).at(10, 17, 4).direct_normal, 0);
  EXPECT_EQ(read(with_cell(12, 14, "\"7.5\"")).at(10, 17, 4).direct_normal, 7.5);
  for (const char* filler : {"", " ", "-6", "-99", "-9999", "9999", "9999.", "99999", "999999"})
    EXPECT_FALSE(read(with_cell(12, 15, filler)).at(10, 17, 4).diffuse_horizontal) << filler;
  for (const char* filler : {"", "-9999", "9999", "9999.", "99999", "999999", "no"})
    EXPECT_FALSE(read(with_cell(21, 18, filler)).at(10, 17, 13).diffuse_horizontal_lux) << filler;
}

TEST_F(Epw, OfSeveralYearsTheOneAskedForCounts) {
  std::vector<std::string> lines = weather_lines();
  for (int hour = 1; hour <= 24; ++hour) {
    std::string row = lines[static_cast<std::size_t>(7 + hour)];
    lines.push_back(row.replace(0, 4, "2005"));
  }
  const Weather weather = read(lines);
  EXPECT_EQ(weather.at(10, 17, 13, 2005).line, 45);
  EXPECT_EQ(weather.at(10, 17, 13, 2026).line, 21);
  EXPECT_EQ(weather.at(10, 17, 13).line, 21);
}

TEST_F(Epw, ALineWithoutADateIsNoHourAndIsNamedWhenOneIsMissed) {
  const Weather weather = read(with_cell(12, 3, "25"));
  EXPECT_EQ(weather.at(10, 17, 13).direct_normal, 600);
  try {
    weather.at(10, 17, 4);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "city.epw: has no hour 4 of 10/17 (month/day); it goes from 10/17 to 10/17. In line 12 "
                 "the hour = 25 is outside [0, 24]");
  }
  EXPECT_EQ(read(with_cell(12, 1, "1.5")).hours[3].flaw, "the month = 1.5 is not a whole number");
}

TEST_F(Epw, LinesMayEndInCrAloneAndUtf16IsNamed) {
  std::string content = joined(weather_lines());
  std::string utf16 = "\xff\xfe";
  for (const char c : content) utf16 += c, utf16 += '\0';
  std::replace(content.begin(), content.end(), '\n', '\r');
  EXPECT_EQ(read_epw(folder_.write("city.epw", content)).hours.size(), 24u);
  EXPECT_EQ(refused_text(utf16), "city.epw: is UTF-16 text; save it as UTF-8");
}

TEST_F(Epw, ShortFilesAreRefused) {
  std::vector<std::string> lines = weather_lines();
  lines.resize(20);
  EXPECT_EQ(refused(lines), "city.epw: has 12 hours; its DATA PERIODS say 24. The file is cut short");
  lines.resize(5);
  EXPECT_EQ(refused(lines), "city.epw: ends after 5 lines; the header of an EPW file has 8");
  EXPECT_EQ(refused(with_cell(8, 6, "12/31")),
            "city.epw: has 24 hours; its DATA PERIODS say 1824. The file is cut short");
  EXPECT_EQ(refused_text("LOCATION"), "city.epw:1: the latitude is missing: the line has 1 values");
}

TEST_F(Epw, HoursThatAreNotThereAreNamed) {
  const Weather weather = read(weather_lines());
  try {
    weather.at(6, 21, 12);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "city.epw: has no hour 12 of 6/21 (month/day); it goes from 10/17 to 10/17");
  }
}

TEST_F(Epw, OfDenverHasTheKnownSums) {
  // ../shared/data/weather/SOURCES.md gives the sums over the year.
  const std::filesystem::path file = std::filesystem::path(CLERESTORY_SOURCE_DIR) / ".." / "shared" / "data" /
                                     "weather" / "USA_CO_Denver.Intl.AP.725650_TMY3.epw";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "../shared/data is not here";
  const Weather weather = read_epw(file);
  ASSERT_EQ(weather.hours.size(), 8760u);
  double direct = 0, diffuse = 0;
  for (const WeatherHour& h : weather.hours)
    direct += h.direct_normal.value_or(0), diffuse += h.diffuse_horizontal.value_or(0);
  EXPECT_NEAR(direct / 1000, 1977.6, 0.05);
  EXPECT_NEAR(diffuse / 1000, 556.5, 0.05);
  EXPECT_EQ(weather.place.timezone, -7);
}

}  // namespace
}  // namespace clerestory
