#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "io/text.h"

namespace clerestory {
namespace {

TEST(NumbersBeyondDouble, AreZeroOrInfiniteBySizeAndNotByTheSignOfTheExponent) {
  const std::string zeros(400, '0');
  EXPECT_EQ(to_number("1e-400"), 0.0);
  EXPECT_EQ(to_number("0." + zeros + "1"), 0.0);
  EXPECT_EQ(to_number("-0." + zeros + "1e20"), 0.0);
  EXPECT_EQ(to_number("1e400"), INFINITY);
  EXPECT_EQ(to_number("-1e400"), -INFINITY);
  EXPECT_EQ(to_number("1" + zeros + "e-5"), INFINITY);
  EXPECT_EQ(to_number("1e99999999999999999999"), INFINITY);
  EXPECT_EQ(to_number("1e-99999999999999999999"), 0.0);
}

TEST(NumbersBeyondDouble, AreNotThoseThatOnlyLookIt) {
  const std::string zeros(400, '0');
  EXPECT_EQ(to_number("1" + zeros + "e-400"), 1.0);
  EXPECT_EQ(to_number("0." + zeros + "1e401"), 1.0);
  EXPECT_EQ(to_number("1.7976931348623157e308"), 1.7976931348623157e308);
}

}  // namespace
}  // namespace clerestory
