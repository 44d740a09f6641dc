#include "eigengrain/base/adjacency.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/base/vec.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eigengrain {
namespace {

TEST(CrossMatrix, MultipliesLikeTheCrossProduct) {
  const Vec3 r(1, -2, 3);
  const Vec3 v(0.5, 4, -1);
  EXPECT_EQ(Vec3(cross_matrix(r) * v), r.cross(v));
}

TEST(Adjacency, GroupsByRowInOrderAndLeavesNegativeRowsOut) {
  const std::vector<std::int32_t> row_of{2, 0, -1, 2, 0, 2};
  const Adjacency rows = group_by_row(4, row_of);
  EXPECT_EQ(rows.rows(), 4);
  EXPECT_THAT(rows.links(0), testing::ElementsAre(1, 4));
  EXPECT_THAT(rows.links(1), testing::IsEmpty());
  EXPECT_THAT(rows.links(2), testing::ElementsAre(0, 3, 5));
  EXPECT_THAT(rows.links(3), testing::IsEmpty());
}

TEST(InputError, ListsEveryMistakeWithItsPlace) {
  const InputError error({{"a.yaml", 3, "first"}, {"b.txt", 0, "second"}, {"", 0, "third"}});
  EXPECT_STREQ(error.what(), "a.yaml:3: first\nb.txt: second\nthird");
  EXPECT_EQ(error.mistakes().size(), 3U);
}

TEST(ForChunks, ChunksDoNotDependOnThreads) {
  const auto chunks = [](int count) {
    set_threads(count);
    std::vector<std::pair<std::int64_t, std::int64_t>> seen(4);
    for_chunks(10, 3, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
      seen[static_cast<std::size_t>(chunk)] = {begin, end};
    });
    return seen;
  };
  const auto one = chunks(1);
  EXPECT_EQ(one, chunks(2));
  EXPECT_EQ(one.back(), std::pair(std::int64_t{9}, std::int64_t{10}));
}

TEST(ForChunks, HandsOnExceptions) {
  const auto throwing = [](std::int64_t begin, std::int64_t, std::int64_t) {
    if (begin == 6) throw InputError("seven");
  };
  EXPECT_THROW(for_chunks(10, 3, throwing), InputError);
}

}  // namespace
}  // namespace eigengrain
