#include "report/labels.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <vector>

namespace eigengrain::report {
namespace {

const Box frame{0, 0, 700, 400};

void expect_no_overlap(const std::vector<LabelWish>& wishes,
                       const std::vector<std::optional<PlacedLabel>>& labels) {
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!labels[i]) continue;
    EXPECT_TRUE(frame.holds(labels[i]->box)) << i;
    for (std::size_t j = 0; j < labels.size(); ++j) {
      EXPECT_FALSE(labels[i]->box.overlaps(Box::about(wishes[j].mark, 4))) << i << " covers mark " << j;
      if (j != i && labels[j]) {
        EXPECT_FALSE(labels[i]->box.overlaps(labels[j]->box)) << i << " and " << j;
      }
    }
  }
}

TEST(PlaceLabels, PutsALonelyLabelToTheRightOfItsMark) {
  const std::vector<LabelWish> wishes{{{100, 200}, 60, 12}};
  const auto labels = place_labels(wishes, frame);
  ASSERT_TRUE(labels[0]);
  EXPECT_GT(labels[0]->box.left, 100);
  EXPECT_NEAR(0.5 * (labels[0]->box.top + labels[0]->box.bottom), 200, 1e-9);
  EXPECT_FALSE(labels[0]->leader);
}

TEST(PlaceLabels, TurnsAwayFromTheFrame) {
  const auto labels = place_labels(std::vector<LabelWish>{{{690, 200}, 60, 12}}, frame);
  ASSERT_TRUE(labels[0]);
  EXPECT_LT(labels[0]->box.right, 690);
}

TEST(PlaceLabels, FindsRoomForThirtyNamesOfOnePlace) {
  const std::vector<LabelWish> wishes(30, {{350, 200}, 100, 13});
  const auto labels = place_labels(wishes, frame);
  for (const auto& label : labels) EXPECT_TRUE(label);
  expect_no_overlap(wishes, labels);
}

TEST(PlaceLabels, NeverCoversAnythingWhateverTheMarks) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 60; ++trial) {
    const double crowd = uniform(random);  // from one heap to all over the frame
    std::vector<LabelWish> wishes;
    for (int k = 0; k < 28; ++k)
      wishes.push_back(
          {{350 + 680 * crowd * (uniform(random) - 0.5), 200 + 380 * crowd * (uniform(random) - 0.5)},
           30 + 90 * uniform(random),
           13});
    const auto labels = place_labels(wishes, frame);
    for (const auto& label : labels) EXPECT_TRUE(label) << "trial " << trial;
    expect_no_overlap(wishes, labels);
  }
}

TEST(PlaceLabels, LeavesOutWhatHasNoRoom) {
  const std::vector<LabelWish> wishes{{{350, 200}, 900, 13}};
  EXPECT_FALSE(place_labels(wishes, frame)[0]);
}

TEST(PlaceLabels, KeepsClearOfObstacles) {
  const std::vector<Box> obstacles{{110, 150, 300, 250}};
  const auto labels = place_labels(std::vector<LabelWish>{{{100, 200}, 60, 12}}, frame, obstacles);
  ASSERT_TRUE(labels[0]);
  EXPECT_FALSE(labels[0]->box.overlaps(obstacles[0]));
}

TEST(Crosses, SegmentsAndBoxes) {
  const Box box{10, 10, 20, 20};
  EXPECT_TRUE(crosses(box, {0, 15}, {30, 15}));
  EXPECT_TRUE(crosses(box, {0, 0}, {30, 30}));
  EXPECT_TRUE(crosses(box, {12, 12}, {13, 14}));
  EXPECT_FALSE(crosses(box, {0, 15}, {9, 15}));
  EXPECT_FALSE(crosses(box, {0, 12}, {12, 0}));
  EXPECT_FALSE(crosses(box, {5, 0}, {5, 30}));
}

TEST(Spread, LeavesAloneWhatHasRoom) {
  const std::vector<double> wished{30, 10, 50};
  EXPECT_EQ(spread(wished, 15, 0, 100), wished);
}

TEST(Spread, CentresWhatIsTooCloseOnItsWishes) {
  EXPECT_EQ(spread(std::vector<double>{50, 50, 50}, 10, 0, 100), (std::vector<double>{40, 50, 60}));
}

TEST(Spread, KeepsOrderDistanceAndEnds) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 100);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> wished(20);
    for (double& w : wished) w = uniform(random);
    const std::vector<double> placed = spread(wished, 5, 0, 100);
    for (std::size_t i = 0; i < wished.size(); ++i) {
      EXPECT_GE(placed[i], -1e-9);
      EXPECT_LE(placed[i], 100 + 1e-9);
      for (std::size_t j = 0; j < wished.size(); ++j)
        if (wished[i] < wished[j]) {
          EXPECT_GE(placed[j] - placed[i], 5 - 1e-9);
        }
    }
  }
}

TEST(Spread, ComesCloserWhereThereAreTooMany) {
  const std::vector<double> placed = spread(std::vector<double>(11, 3.0), 50, 0, 100);
  for (std::size_t k = 0; k < placed.size(); ++k) EXPECT_NEAR(placed[k], 10.0 * static_cast<double>(k), 1e-9);
}

}  // namespace
}  // namespace eigengrain::report
