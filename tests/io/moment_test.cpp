// Series of times as people write them.

#include "io/moment.h"

#include <gtest/gtest.h>

#include "solver/model/error.h"

namespace clerestory {
namespace {

std::vector<std::string> series(const std::string& written) {
  std::vector<std::string> out;
  for (const Moment& moment : read_times(written, "--times")) out.push_back(moment_text(moment));
  return out;
}

std::string refusal(const std::string& written) {
  try {
    return "(it was read: " + std::to_string(read_times(written, "--times").size()) + " times)";
  } catch (const InputError& error) {
    return error.what();
  }
}

using Names = std::vector<std::string>;

TEST(SeriesOfTimes, HoldsBothEndsAndEveryStepBetween) {
  EXPECT_EQ(series("2026-03-21T06:00/20:00/PT1H").size(), 15u);
  EXPECT_EQ(series("2026-03-21T06:00/08:00/PT1H"), (Names{"2026-03-21T06:00", "2026-03-21T07:00", "2026-03-21T08:00"}));
  EXPECT_EQ(series("2026-03-21T06:00/07:29/PT30M").back(), "2026-03-21T07:00");
  EXPECT_EQ(series("2026-03-21T06:00/06:00/PT1H"), (Names{"2026-03-21T06:00"}));
  EXPECT_EQ(series("2026-03-21T06:00:30/06:01:00/PT10S").at(1), "2026-03-21T06:00:40");
}

TEST(SeriesOfTimes, GoesOverMidnightAndMonthsAndLeapDays) {
  EXPECT_EQ(series("2026-12-31T22:00/2027-01-01T02:00/PT2H"),
            (Names{"2026-12-31T22:00", "2027-01-01T00:00", "2027-01-01T02:00"}));
  EXPECT_EQ(series("2028-02-28T12:00/2028-03-01T12:00/P1D").at(1), "2028-02-29T12:00");
  EXPECT_EQ(series("2026-01-01T12:00/2026-12-31T12:00/P7D").size(), 53u);
  EXPECT_EQ(series("2026-01-01T00:00/2026-01-03T00:00/P1DT1H30M").at(1), "2026-01-02T01:30");
}

TEST(SeriesOfTimes, IsCountedInHoursFromTheMidnightOfItsFirstDay) {
  const std::vector<Moment> times = read_times("2026-12-31T06:30/2027-01-01T06:30/PT12H", "--times");
  EXPECT_DOUBLE_EQ(hours_since(times.front(), times.front()), 6.5);
  EXPECT_DOUBLE_EQ(hours_since(times.front(), times.back()), 30.5);
}

TEST(SeriesOfTimes, IsRefusedWithWhatIsWrong) {
  EXPECT_EQ(refusal("noon"),
            "--times 'noon' is no series of times; write it as 2026-03-21T06:00/20:00/PT1H: from, to, step");
  EXPECT_EQ(refusal("2026-03-21T06:00/20:00"),
            "--times '2026-03-21T06:00/20:00' is no series of times; write it as 2026-03-21T06:00/20:00/PT1H: from, "
            "to, step");
  EXPECT_EQ(refusal("2026-03-21/20:00/PT1H"),
            "--times '2026-03-21' is not a time; write it as 2026-06-21T12:00, local standard time without a zone");
  EXPECT_NE(refusal("2026-02-30T06:00/20:00/PT1H").find("'2026-02-30T06:00' does not exist"), std::string::npos);
  EXPECT_NE(refusal("2026-03-21T06:00/25:00/PT1H").find("does not exist"), std::string::npos);
  EXPECT_NE(refusal("2026-03-21T06:00/05:00/PT1H").find("ends before it begins"), std::string::npos);
  EXPECT_NE(refusal("2026-03-21T06:00/20:00/PT0H").find("a step of 0 comes to no end; write PT1H"), std::string::npos);
  EXPECT_NE(refusal("2026-03-21T06:00/20:00/PT1S").find("has 50401 times; at most 200: take a longer step"),
            std::string::npos);
  for (const std::string step :
       {"1H", "PT", "P", "", "PT1", "P1H", "PT1D", "PT1.5H", "PT-1H", "PT1H ", "P1DT", "PT1M1H"})
    EXPECT_NE(refusal("2026-03-21T06:00/20:00/" + step).find("is no duration; write PT1H, PT30M or P1D"),
              std::string::npos)
        << step << ": " << refusal("2026-03-21T06:00/20:00/" + step);
}

}  // namespace
}  // namespace clerestory
