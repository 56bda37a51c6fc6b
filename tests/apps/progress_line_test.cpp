#include "apps/progress_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

namespace clerestory {
namespace {

using Seconds = std::chrono::duration<double>;

ProgressLine::Time at(double seconds) {
  return ProgressLine::Time{} + std::chrono::hours(1) +
         std::chrono::duration_cast<std::chrono::nanoseconds>(Seconds(seconds));
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(ProgressLine, WithoutATerminalThereAreFewPlainLines) {
  std::ostringstream out;
  ProgressLine progress(out, false, at(0));
  for (int i = 0; i <= 2000; ++i) progress.update("shoot", i / 2000.0, at(i * 0.01));
  EXPECT_EQ(lines(out.str()), 4u) << out.str();  // after 1, 6, 11 and 16 seconds of 20
  EXPECT_EQ(out.str().find('\033'), std::string::npos);
  EXPECT_NE(out.str().find("shoot: 55 %, 11.0 s elapsed, about 9.0 s left"), std::string::npos) << out.str();
}

TEST(ProgressLine, ShortStagesAreNotNamed) {
  std::ostringstream out;
  ProgressLine progress(out, false, at(0));
  for (int i = 0; i < 100; ++i) progress.update(i % 2 ? "a" : "b", 0.5, at(i * 0.001));
  EXPECT_EQ(out.str(), "");
}

TEST(ProgressLine, OnATerminalABarIsDrawnOverItselfAtMostTenTimesASecond) {
  std::ostringstream out;
  ProgressLine progress(out, true, at(0));
  for (int i = 0; i <= 1000; ++i) progress.update("shoot", i / 1000.0, at(i * 0.001));
  const std::string text = out.str();
  EXPECT_EQ(lines(text), 0u);
  const auto bars = std::count(text.begin(), text.end(), '\r');
  EXPECT_GE(bars, 9);
  EXPECT_LE(bars, 11);
  EXPECT_NE(text.find("[############------------] shoot 50 %"), std::string::npos) << text;
  progress.clear();
  EXPECT_TRUE(out.str().ends_with("\r\033[K"));
}

TEST(ProgressLine, ASenselessShareDoesNoHarm) {
  std::ostringstream out;
  ProgressLine progress(out, true, at(0));
  progress.update("shoot", std::numeric_limits<double>::quiet_NaN(), at(1));
  progress.update("shoot", 7, at(2));
  EXPECT_NE(out.str().find("shoot 0 %"), std::string::npos);
  EXPECT_NE(out.str().find("shoot 100 %"), std::string::npos);
}

}  // namespace
}  // namespace clerestory
