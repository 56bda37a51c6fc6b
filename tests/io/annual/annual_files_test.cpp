// What `annual` writes: the report, columns of sensors, series of hours, the folder of Ladybug Tools.

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/annual/annual_report.h"
#include "io/annual/honeybee_folder.h"
#include "io/annual/hour_series.h"
#include "io/annual/npy_file.h"
#include "io/write_sensors.h"
#include "solver/model/error.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const std::vector<SensorPoint> kPoints = {
    {{1, 2, 0.85}, {0, 0, 1}}, {{1.5, 2, 0.85}, {0, 0, 1}}, {{3, 4, 5}, {1, 0, 0}}};
const std::vector<int> kHours = {7, 12, 4000, 8759};
/// Total and direct of three points in four hours.
const std::vector<float> kTotal = {1, 2, 3, 4, 10, 20, 30, 40, 0.25f, 0, 1e5f, 7};
const std::vector<float> kDirect = {0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 9e4f, 0};

/// A .npy file by the words of its format: what the header says, and the bytes behind it.
struct Npy {
  std::string header;
  std::string bytes;

  explicit Npy(const fs::path& file) {
    const std::string all = read_text(file);
    EXPECT_EQ(all.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8)) << file;
    const auto length = static_cast<unsigned char>(all[8]) + 256u * static_cast<unsigned char>(all[9]);
    EXPECT_EQ((10 + length) % 64, 0u);
    header = all.substr(10, length);
    EXPECT_EQ(header.back(), '\n');
    bytes = all.substr(10 + length);
  }
  template <class T>
  std::vector<T> values() const {
    std::vector<T> numbers(bytes.size() / sizeof(T));
    std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(T));
    return numbers;
  }
};

/// Whether Python has a library.
bool python_has(const std::string& library) {
  return std::system(("python3 -c 'import " + library + "' 2>/dev/null").c_str()) == 0;
}

/// Adds the rows in two blocks.
void fill(HourSeries& series) {
  const std::span<const float> total(kTotal), direct(kDirect);
  series.add(total.first(8), direct.first(8));
  series.add(total.last(4), direct.last(4));
}

AreaOfYear room() {
  AreaOfYear area{.name = "R1 \"north\"", .points = 40, .year = {}, .blinds = {}};
  area.year.area = 20.5;
  area.year.sDA = {52.5, 30, 61};
  area.year.ASE_more_than = {12, 10, 15};
  area.year.ASE_at_least = {12.5, 10, 15};
  area.year.target_share = {80, 55, 20};
  area.year.minimum_share = {100, 96, 55};
  area.year.level = En17037Level::medium;
  area.year.mean = 431.25;
  area.blinds = {321, 4};
  return area;
}

TEST(AnnualReport, TellsFiguresWithTheirIntervalsAndTheRulesInForce) {
  AnnualReport report;
  report.scene = "office.json", report.weather = "city.epw", report.city = "Golden";
  report.schedule = "8-18", report.occupied_hours = 3650, report.lit_hours = 4513;
  report.error_grids.total = 0.03;
  report.rooms = {room()};
  const Json json = Json::parse(annual_json(report));
  EXPECT_EQ(json["schedule"]["occupied_hours"], 3650);
  EXPECT_EQ(json["weather"]["city"], "Golden");
  EXPECT_EQ(json["illuminance_error"]["grids"]["total"], 0.03);
  EXPECT_NE(json["rules"]["ASE"].get<std::string>().find("more than 250 occupied hours"), std::string::npos);
  ASSERT_EQ(json["rooms"].size(), 1u);
  EXPECT_TRUE(json["grids"].is_array() && json["grids"].empty());
  const Json& r = json["rooms"][0];
  EXPECT_EQ(r["name"], "R1 \"north\"");
  EXPECT_EQ(r["area"], 20.5);
  EXPECT_EQ(r["sDA"], 52.5);
  EXPECT_EQ(r["sDA_low"], 30);
  EXPECT_EQ(r["sDA_high"], 61);
  EXPECT_EQ(r["ASE"], 12);
  EXPECT_EQ(r["ASE_at_least"]["value"], 12.5);
  EXPECT_EQ(r["EN17037"]["level"], "medium");
  EXPECT_EQ(r["EN17037"]["target_share"], 55);
  EXPECT_EQ(r["EN17037"]["minimum_share"], 96);
  EXPECT_EQ(r["EN17037"]["levels"]["high"]["target_share"], 20);
  EXPECT_EQ(r["LEED_v4_1"]["points"], 1);
  EXPECT_EQ(r["LEED_v4_1"]["points_low"], 0);
  EXPECT_EQ(r["LEED_v4_1"]["points_high"], 2);
  EXPECT_EQ(r["LEED_v4_1"]["ASE_to_be_explained"], true);
  EXPECT_EQ(r["hours_blinds_closed"], 321);
  EXPECT_EQ(r["hours_not_complying"], 4);
}

TEST(AnnualReport, TheAreaOfPointsThatStandForNoneIsNotKnown) {
  AnnualReport report;
  report.grids = {room()};
  report.grids[0].has_area = false;
  EXPECT_TRUE(Json::parse(annual_json(report))["grids"][0]["area"].is_null());
}

TEST(AnnualReport, LeavesLeedOutAtAnotherThreshold) {
  AnnualReport report;
  report.threshold = 500;
  report.grids = {room()};
  const Json json = Json::parse(annual_json(report));
  EXPECT_FALSE(json["grids"][0].contains("LEED_v4_1"));
  EXPECT_NE(json["rules"]["sDA"].get<std::string>().find("DA 500"), std::string::npos);
}

TEST(SensorFigures, StandBehindTheirPoints) {
  const TempFolder folder;
  AtomicFile file(folder / "s.csv");
  const std::vector<std::string> names = {"DA_300", "ASE_hours"};
  write_sensor_figures(file, std::span(kPoints).first(2), names, std::vector{12.5, 250.0, 100.0 / 3, 0.0});
  file.commit();
  EXPECT_EQ(read_text(folder / "s.csv"),
            "x,y,z,nx,ny,nz,DA_300,ASE_hours\n1,2,0.85,0,0,1,12.5,250\n1.5,2,0.85,0,0,1,33.333333333333336,0\n");
}

TEST(NpyFile, HeaderSaysTypeAndShape) {
  EXPECT_NE(npy_header("f4", {3, 4}).find("{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), }"),
            std::string::npos);
  EXPECT_NE(npy_header("i4", {8}).find("'shape': (8,), }"), std::string::npos);
}

TEST(HourSeries, AsAFolderHasOneArrayAFile) {
  const TempFolder folder;
  const auto series = make_hour_series(folder / "hours", kHours, kPoints);
  fill(*series);
  for (const char* file : {"hour.npy", "sensors/position.npy", "sensors/normal.npy", "sensors/total.npy"})
    EXPECT_FALSE(fs::exists(folder / (std::string("hours/") + file))) << file << " before all is whole";
  series->commit();
  const Npy total(folder / "hours/sensors/total.npy");
  EXPECT_NE(total.header.find("(3, 4)"), std::string::npos) << total.header;
  EXPECT_EQ(total.values<float>(), kTotal);
  EXPECT_EQ(Npy(folder / "hours/sensors/direct.npy").values<float>(), kDirect);
  EXPECT_EQ(Npy(folder / "hours/hour.npy").values<int>(), kHours);
  EXPECT_EQ(Npy(folder / "hours/sensors/position.npy").values<double>(),
            (std::vector<double>{1, 2, 0.85, 1.5, 2, 0.85, 3, 4, 5}));
  EXPECT_EQ(Npy(folder / "hours/sensors/normal.npy").values<double>()[6], 1);
}

TEST(HourSeries, AsAFolderIsReadByNumPy) {
  if (!python_has("numpy")) GTEST_SKIP() << "no NumPy";
  const TempFolder folder;
  const auto series = make_hour_series(folder / "hours", kHours, kPoints);
  fill(*series);
  series->commit();
  const std::string script = "import numpy as n; d = '" + (folder / "hours") +
                             "'; t = n.load(d + '/sensors/total.npy'); "
                             "assert t.shape == (3, 4) and t.dtype == n.float32 and t[1, 3] == 40 and t[2, 2] == 1e5; "
                             "h = n.load(d + '/hour.npy'); assert h.tolist() == [7, 12, 4000, 8759]; "
                             "assert n.load(d + '/sensors/position.npy')[2].tolist() == [3, 4, 5]";
  EXPECT_EQ(std::system(("python3 -c \"" + script + "\"").c_str()), 0);
}

TEST(HourSeries, AsHdf5HasTheSameArraysAndTheSameBytesEachTime) {
  const TempFolder folder;
  for (const char* name : {"a.h5", "b.hdf5"}) {
    const auto series = make_hour_series(folder / name, kHours, kPoints);
    fill(*series);
    EXPECT_FALSE(fs::exists(folder / name)) << "before it is whole";
    series->commit();
  }
  const std::string bytes = read_text(folder / "a.h5");
  EXPECT_EQ(bytes, read_text(folder / "b.hdf5"));
  EXPECT_EQ(bytes.substr(1, 3), "HDF");
  // Arrays stand in the file as they are, one value after the other.
  EXPECT_NE(bytes.find({reinterpret_cast<const char*>(kTotal.data()), kTotal.size() * sizeof(float)}), bytes.npos);
  EXPECT_NE(bytes.find({reinterpret_cast<const char*>(kHours.data()), kHours.size() * sizeof(int)}), bytes.npos);
  EXPECT_EQ(folder.listing(), "a.h5 b.hdf5 ");
}

TEST(HourSeries, AsHdf5IsReadByItsOwnTools) {
  if (std::system("h5dump --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no h5dump";
  const TempFolder folder;
  auto series = make_hour_series(folder / "a.h5", kHours, kPoints);
  fill(*series);
  series->commit();
  series.reset();  // it holds a lock on the file
  const std::string out = folder / "out.txt";
  ASSERT_EQ(std::system(("h5dump -y -w 0 -d /sensors/total -d /hour " + (folder / "a.h5") + " > " + out).c_str()), 0);
  const std::string dump = read_text(out);
  EXPECT_NE(dump.find("1, 2, 3, 4,"), std::string::npos) << dump;
  EXPECT_NE(dump.find("7, 12, 4000, 8759"), std::string::npos) << dump;
  EXPECT_NE(dump.find("\"lx\""), std::string::npos) << dump;
}

TEST(HourSeries, ThatIsNotFinishedLeavesWhatWasThere) {
  const TempFolder folder;
  folder.write("a.h5", "old");
  fill(*make_hour_series(folder / "a.h5", kHours, kPoints));
  EXPECT_EQ(read_text(folder / "a.h5"), "old");
  EXPECT_EQ(folder.listing(), "a.h5 ");
}

TEST(HourSeries, ThatCannotBeWrittenIsRefused) {
  const TempFolder folder;
  folder.write("file", "x");
  EXPECT_THROW(make_hour_series(folder / "file", kHours, {}), InputError);
  EXPECT_THROW(make_hour_series(folder / "none/a.h5", kHours, {}), InputError);
  EXPECT_EQ(bytes_of_series(4000, 3), 3 * (8 * 4000 + 48u));
}

TEST(HoneybeeFolder, HoldsWhatLadybugToolsRead) {
  const TempFolder folder;
  const fs::path out = folder / "results";
  HoneybeeFolder results(out, kHours, {{"desk", 3}, {"R2/a b", 1}, {"r2_a_b", 0}});
  const std::span<const float> total(kTotal), direct(kDirect);
  results.add(0, total.first(4), direct.first(4));
  results.add(0, total.last(8), direct.last(8));
  results.add(1, total.last(4), direct.last(4));
  EXPECT_FALSE(fs::exists(out / "grids_info.json"));
  const HoneybeeMetrics one{{12.345}, {20}, {30}, {40}, {30}},
      three{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  results.commit(std::vector{three, one, HoneybeeMetrics{}});

  EXPECT_EQ(Npy(out / "__static_apertures__/default/total/desk.npy").values<float>(), kTotal);
  EXPECT_EQ(Npy(out / "__static_apertures__/default/direct/desk.npy").values<float>(), kDirect);
  EXPECT_EQ(Npy(out / "__static_apertures__/default/total/R2_a_b.npy").values<float>(),
            std::vector<float>(kTotal.end() - 4, kTotal.end()));
  EXPECT_EQ(read_text(out / "sun-up-hours.txt"), "7.5\n12.5\n4000.5\n8759.5\n");
  const Json study = Json::parse(read_text(out / "study_info.json"));
  EXPECT_EQ(study["timestep"], 1);
  EXPECT_EQ(study["study_hours"].size(), 8760u);
  EXPECT_EQ(study["study_hours"][8759], 8759.5);
  const Json info = Json::parse(read_text(out / "grids_info.json"));
  ASSERT_EQ(info.size(), 3u);
  EXPECT_EQ(info[0], (Json{{"name", "desk"},
                           {"identifier", "desk"},
                           {"count", 3},
                           {"group", ""},
                           {"full_id", "desk"},
                           {"light_path", Json::array({Json::array({"__static_apertures__"})})}}));
  EXPECT_EQ(info[1]["name"], "R2/a b");
  EXPECT_EQ(info[1]["full_id"], "R2_a_b");
  EXPECT_EQ(info[2]["full_id"], "r2_a_b_2") << "file systems that know no capitals";
  const Json states = Json::parse(read_text(out / "grid_states.json"));
  EXPECT_EQ(states, (Json{{"desk", Json::object()}, {"R2_a_b", Json::object()}, {"r2_a_b_2", Json::object()}}));
  EXPECT_EQ(read_text(out / "metrics/da/R2_a_b.da"), "12.35\n");
  EXPECT_EQ(read_text(out / "metrics/udi_lower/desk.udi"), "1.00\n2.00\n3.00\n");
  EXPECT_EQ(Json::parse(read_text(out / "metrics/udi_upper/grids_info.json")), info);

  // A run that does not come to its end leaves all of it.
  HoneybeeFolder(out, kHours, {{"desk", 1}}).add(0, total.first(4), direct.first(4));
  EXPECT_EQ(Json::parse(read_text(out / "grids_info.json")), info);
  EXPECT_EQ(Npy(out / "__static_apertures__/default/total/desk.npy").values<float>(), kTotal);
}

}  // namespace
}  // namespace clerestory
