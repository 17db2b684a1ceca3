#include "bezel/base/error.hpp"

#include <gtest/gtest.h>

namespace bezel {
namespace {

TEST(InputError, NamesThePlaceItKnows) {
  EXPECT_STREQ(InputError("bad degree").what(), "bad degree");
  const InputError full(InputPlace{"wing.msh", 4182, "triangle", 1907},
                        "vertex 5012 does not exist");
  EXPECT_STREQ(full.what(), "wing.msh:4182: triangle 1907: vertex 5012 does not exist");
  EXPECT_EQ(full.message(), "vertex 5012 does not exist");
  EXPECT_EQ(full.place().line, 4182);
  EXPECT_STREQ(InputError(InputPlace{"", 3, "node", -1}, "x").what(), "line 3: node: x");
  EXPECT_STREQ(InputError(InputPlace{"a.vtu", 0, "", -1}, "x").what(), "a.vtu: x");
}

TEST(InputError, InFileFillsOnlyWhatIsUnknown) {
  const InputError bare(InputPlace{"", 0, "node", 4}, "x");
  EXPECT_STREQ(bare.in_file("a.msh", 9).what(), "a.msh:9: node 4: x");
  EXPECT_STREQ(bare.in_file("a.msh", 9).in_file("b.msh", 1).what(), "a.msh:9: node 4: x");
}

TEST(InternalError, AsksForTheInput) {
  EXPECT_STREQ(InternalError("no root").what(),
               "internal error: no root; this is a bug, please send the input");
}

}  // namespace
}  // namespace bezel
