#include "pipeline/wording.h"

#include <gtest/gtest.h>

namespace clerestory {
namespace {

TEST(Wording, NumbersReadAsPeopleWriteThem) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
  EXPECT_EQ(grouped(12345678), "12,345,678");
  EXPECT_EQ(rounded(0), "0");
  EXPECT_EQ(rounded(3.14159), "3.14");
  EXPECT_EQ(rounded(-0.012345), "-0.0123");
  EXPECT_EQ(rounded(12345.6), "12346");
  EXPECT_EQ(rounded(1e-9), "1e-09");
  EXPECT_EQ(percent(0.0234), "2.34 %");
  EXPECT_EQ(bytes(512), "512 B");
  EXPECT_EQ(bytes(3 << 20), "3.00 MiB");
  EXPECT_EQ(counted(1, "row"), "1 row");
  EXPECT_EQ(counted(2000, "row"), "2,000 rows");
}

TEST(Wording, DurationsChangeUnitAsTheyGrow) {
  EXPECT_EQ(duration(0.0123), "12 ms");
  EXPECT_EQ(duration(4.24), "4.2 s");
  EXPECT_EQ(duration(59.99), "1 min 0 s");
  EXPECT_EQ(duration(200), "3 min 20 s");
}

}  // namespace
}  // namespace clerestory
