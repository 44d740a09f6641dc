#include "io/packing_reader.hpp"
#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Packing, ReadsRowsBetweenCommentsAndBlankLines) {
  Diagnostics diagnostics;
  const Packing packing =
      parse_packing("# x y z r\n\n1 2 3 0.5 # one\r\n \t\n-1e-3\t+2 .5 1e-2", "p", diagnostics);
  EXPECT_FALSE(diagnostics.any());
  EXPECT_THAT(packing.position, ElementsAre(Vec3(1, 2, 3), Vec3(-1e-3, 2, 0.5)));
  EXPECT_THAT(packing.radius, ElementsAre(0.5, 1e-2));
  EXPECT_THAT(packing.line, ElementsAre(3, 5));
}

TEST(Packing, ReportsEachBadRowWithLineAndValue) {
  Diagnostics diagnostics;
  const Packing packing = parse_packing(
      "0 0 0\n"
      "0 0 0 1 7\n"
      "0 zero 0 1\n"
      "0 0 0 1x\n"
      "nan 0 0 1\n"
      "0 0 -inf 1\n"
      "0 0 0 0\n"
      "0 0 0 -2\n"
      "0 0 0 1e999\n"
      "0,0,0,1\n"
      "0 0 5mm 1\n"
      "0 0 0 1\n",
      "p.txt", diagnostics);
  EXPECT_EQ(packing.line, std::vector<std::int32_t>{12});
  EXPECT_THAT(
      texts_of(diagnostics.mistakes()),
      ElementsAre("p.txt:1: 3 columns; four are wanted: x y z r, in m",
                  "p.txt:2: 5 columns; four are wanted: x y z r, in m",
                  HasSubstr("p.txt:3: y = \"zero\" is not a number"), HasSubstr("p.txt:4: r = \"1x\" is not"),
                  "p.txt:5: x = \"nan\" is not a finite number",
                  "p.txt:6: z = \"-inf\" is not a finite number", "p.txt:7: radius 0 m is not positive",
                  "p.txt:8: radius -2 m is not positive",
                  "p.txt:9: r = \"1e999\" is too large or too small for a number",
                  HasSubstr("p.txt:10: x = \"0,0,0,1\" is not a number; columns are plain numbers in m, "
                            "separated by blanks"),
                  HasSubstr("p.txt:11: z = \"5mm\" is not a number; columns are plain numbers in m")));
}

TEST(Packing, ReadsABigFileAndCapsItsMistakes) {
  std::string text;
  for (int k = 0; k < 200'000; ++k) text += std::to_string(k) + " 0.25 0.5 0.125\n";
  Diagnostics diagnostics;
  const Packing packing = parse_packing(text, "big", diagnostics);
  EXPECT_FALSE(diagnostics.any());
  ASSERT_EQ(packing.radius.size(), 200'000U);
  EXPECT_EQ(packing.position.back(), Vec3(199'999, 0.25, 0.5));
  EXPECT_EQ(packing.line.back(), 200'000);

  std::string bad;
  for (int k = 0; k < 10'000; ++k) bad += "0 0 0 -1\n";
  parse_packing(bad, "bad", diagnostics);
  const std::vector<Mistake> mistakes = diagnostics.mistakes();
  ASSERT_EQ(mistakes.size(), 21U);
  EXPECT_EQ(mistakes.back().message, "and 9,980 more like it");
}

TEST(Packing, MissingFileNamesThePathAndTheNearestFile) {
  const TemporaryFolder folder;
  folder.write("packing_10k.txt", "0 0 0 1\n");
  folder.write("notes.md", "");
  Diagnostics diagnostics;
  const std::string path = (folder.path() / "packng_10k.txt").string();
  EXPECT_TRUE(read_packing_file(path, {"scene.yaml", 4}, diagnostics).radius.empty());
  read_packing_file(folder.path() / "nowhere" / "a.txt", {"scene.yaml", 5}, diagnostics);
  read_packing_file(folder.path(), {"scene.yaml", 6}, diagnostics);
  read_packing_file(folder.path() / "notes.md", {"scene.yaml", 7}, diagnostics);
  EXPECT_THAT(
      texts_of(diagnostics.mistakes()),
      ElementsAre("scene.yaml:4: there is no file \"" + path + "\"; did you mean \"packing_10k.txt\"?",
                  testing::AllOf(HasSubstr("scene.yaml:5: there is no file"), HasSubstr("(nor a folder")),
                  HasSubstr("is a folder, not a file"), HasSubstr("holds no balls")));
}

TEST(Packing, AFileAloneThrowsItsMistakes) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_packing_file(folder.write("good.txt", "0 0 0 1\n")).radius, std::vector<double>{1});
  const auto bad = folder.write("bad.txt", "0 0 0 1\n0 0 0 0\n0 0 0\n");
  try {
    read_packing_file(bad);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.mistakes().size(), 2U);
  }
  EXPECT_THROW(read_packing_file(folder.path() / "none.txt"), InputError);
}

TEST(Packing, WhatIsWrittenIsReadBackToTheBit) {
  const TemporaryFolder folder;
  std::vector<Vec3> centres{{0.1, -1e-300, 1e300}, {1.0 / 3, 5e-324, -0.0}};
  std::vector<double> radii{0x1.fffffffffffffp-1, 1e-5};
  std::mt19937_64 random(1);
  for (int k = 0; k < 1000; ++k) {
    const auto number = [&] { return std::ldexp(static_cast<double>(random() >> 11U), -53); };
    centres.emplace_back(number(), number(), -number());
    radii.push_back(number());
  }
  const auto file = folder.path() / "packing.txt";
  write_packing_file(centres, radii, "two lines\nof comment", file);
  const Packing packing = read_packing_file(file);
  EXPECT_EQ(packing.position, centres);
  EXPECT_EQ(packing.radius, radii);
  EXPECT_EQ(packing.line.front(), 3);
  EXPECT_THROW(write_packing_file(centres, radii, "", folder.path() / "none" / "p.txt"), InputError);
}

}  // namespace
}  // namespace eigengrain::io
