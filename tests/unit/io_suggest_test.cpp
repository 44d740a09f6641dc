#include "eigengrain/io/suggest.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace eigengrain::io {
namespace {

TEST(SpellingDistance, CountsEdits) {
  EXPECT_EQ(spelling_distance("", ""), 0);
  EXPECT_EQ(spelling_distance("", "abc"), 6);
  EXPECT_EQ(spelling_distance("friction", "friction"), 0);
  EXPECT_EQ(spelling_distance("fricton", "friction"), 2);
  EXPECT_EQ(spelling_distance("firction", "friction"), 2);  // a swap is one edit
  EXPECT_EQ(spelling_distance("Friction", "friction"), 1);
  EXPECT_EQ(spelling_distance("kitten", "sitting"), 6);
}

TEST(DidYouMean, NamesOnlyWhatIsNear) {
  const std::vector<std::string> keys{"kn", "ks", "friction", "tension"};
  EXPECT_EQ(did_you_mean("fricton", keys), "; did you mean \"friction\"?");
  EXPECT_EQ(did_you_mean("KN", keys), "; did you mean \"kn\"?");
  EXPECT_EQ(did_you_mean("colour", keys), "");
  EXPECT_EQ(did_you_mean("x", keys), "");
  EXPECT_EQ(did_you_mean("", keys), "");
  EXPECT_EQ(did_you_mean("kn", {}), "");
  EXPECT_EQ(did_you_mean(std::string(100000, 'k'), keys), "");
}

}  // namespace
}  // namespace eigengrain::io
