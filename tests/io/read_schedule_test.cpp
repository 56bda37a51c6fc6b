#include "io/read_schedule.h"

#include <numeric>

#include <gtest/gtest.h>

#include "solver/model/error.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

int hours(const Schedule& schedule) { return std::accumulate(schedule.occupied.begin(), schedule.occupied.end(), 0); }

std::string refused(const std::string& asked) {
  try {
    read_schedule(asked);
    return "(it was read)";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string lines(std::size_t n, const char* value) {
  std::string all;
  for (std::size_t i = 0; i < n; ++i) all += std::string(value) + "\n";
  return all;
}

TEST(Schedule, FromEightToEighteenHas3650HoursThatBeginInThatTime) {
  const Schedule schedule = read_schedule("8-18");
  EXPECT_EQ(schedule.name, "8-18");
  ASSERT_EQ(schedule.occupied.size(), 8760u);
  EXPECT_EQ(hours(schedule), 3650);
  for (const int day : {0, 200, 364})
    for (int h = 0; h < 24; ++h)
      EXPECT_EQ(schedule.occupied[static_cast<std::size_t>(24 * day + h)], h >= 8 && h < 18) << day << " " << h;
}

TEST(Schedule, MayGoOverMidnightOrAllDay) {
  EXPECT_EQ(hours(read_schedule("20-6")), 10 * 365);
  EXPECT_EQ(read_schedule("20-6").occupied[5], 1);
  EXPECT_EQ(read_schedule("20-6").occupied[6], 0);
  EXPECT_EQ(hours(read_schedule("0-24")), 8760);
  EXPECT_EQ(hours(read_schedule("22-24")), 2 * 365);
}

TEST(Schedule, OfAFileHasTheHoursFromAHalfOn) {
  const TempFolder folder;
  const Schedule schedule = read_schedule(folder.write("office.csv", lines(4000, "0.4") + lines(4760, "0.50")));
  EXPECT_EQ(schedule.name, "office.csv");
  EXPECT_EQ(hours(schedule), 4760);
  EXPECT_EQ(schedule.occupied[3999], 0);
  EXPECT_EQ(schedule.occupied[4000], 1);
}

TEST(Schedule, HoursAreHoursWhateverFilesThereAre) {
  EXPECT_TRUE(is_hours_of_day("8-18"));
  EXPECT_TRUE(is_hours_of_day("20-6"));
  EXPECT_FALSE(is_hours_of_day("./8-18"));
  EXPECT_FALSE(is_hours_of_day("office.csv"));
}

TEST(Schedule, WithoutHoursOrOfNoUseIsRefused) {
  const TempFolder folder;
  EXPECT_EQ(refused("8-8"), "--schedule '8-8' has no hours; write the first and the end of the last, as 8-18");
  EXPECT_EQ(refused("0-0"), "--schedule '0-0' has no hours; write the first and the end of the last, as 8-18");
  EXPECT_EQ(refused("8-25"), "--schedule '8-25' has an hour outside [0, 24]; write it as 8-18");
  EXPECT_EQ(refused("nine to five"),
            "--schedule 'nine to five' is neither hours of the day, as 8-18, nor a file of 8760 numbers that is there");
  EXPECT_EQ(refused("8:30-18").substr(0, 21), "--schedule '8:30-18' ");
  EXPECT_EQ(refused(folder.write("a.csv", lines(8760, "0"))), "a.csv: no hour is occupied; hours count from 0.5 on");
  EXPECT_EQ(refused(folder.write("a.csv", lines(8759, "1"))),
            "a.csv: has 8759 hours; a schedule has 8760, one for each hour of a year of 365 days");
  EXPECT_EQ(refused(folder.write("a.csv", "1\noccupied\n")),
            "a.csv:2: 'occupied' is not a number of [0, 1]; a schedule has 8760 of them, a line each");
  EXPECT_EQ(refused(folder.write("a.csv", "1\nnan\n")).substr(0, 14), "a.csv:2: 'nan'");
}

}  // namespace
}  // namespace clerestory
