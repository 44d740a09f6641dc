#include "io/settings_reader.hpp"
#include "unit/io_support.hpp"

#include <gtest/gtest.h>

#include <random>

namespace eigengrain::io {
namespace {

constexpr std::string_view valid = R"(gravity: [0, 0, -9.81 m/s2]
materials:
  - {name: grain, density: &rho 2500}
  - {name: steel, density: *rho}
contacts:
  - between: [grain, grain]
    law: linear
    kn: 1.0e5
    ks: 5.0e4
    friction: 0.5
  - {between: [any, any], law: none}
balls:
  - {file: packing.txt, material: grain}
  - {position: [0.1, 0.1, 0.2], radius: 5 mm, material: grain, fix: [x, wy], velocity: [1, 0, 0], spin: [0, 1, 0]}
  - {lattice: bcc, radius: 20 mm, overlap: 10 um, box: {min: [0.02, 0.02, 0.1], max: [0.2, 0.2, 0.2]}, material: grain}
walls:
  - {plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}
  - {box: {min: [0, 0, 0], max: [0.21, 0.21, 0.254], open: [-x, +x, +z]}, material: steel}
periodic: {box: [0.21, 0.21, 0.25], origin: [0, 0, 0], axes: [x]}
damping: {local: 0.7}
timestep: {policy: fixed, safety: 0.8, dt: 10 us}
run: {steps: 10000, time: 2 s, until: {unbalanced: 1.0e-5}}
histories:
  - {file: a.csv, every: 10, of: [energies, walls], balls: [0, 2]}
outputs: {checkpoint: 100, series: 10}
)";

using Random = std::mt19937_64;

std::size_t below(std::size_t n, Random& random) {
  return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
}

/// One small change: a character replaced, inserted or removed, a piece copied elsewhere, or the end cut off.
void mutate(std::string& text, Random& random) {
  static constexpr std::string_view alphabet =
      "{}[]:,-#&*!|>'\"%@`\t\n \\0189.eEnN?~<\xff\xc2\xb5"
      "ambxyz+/^_=";
  if (text.empty()) text = "a";
  const std::size_t at = below(text.size(), random);
  const char letter = alphabet[below(alphabet.size(), random)];
  switch (below(6, random)) {
    case 0:
      text[at] = letter;
      break;
    case 1:
      text.insert(at, 1, letter);
      break;
    case 2:
      text.erase(at, 1 + below(4, random));
      break;
    case 3:
      text.insert(at, text.substr(below(text.size(), random), below(60, random)));
      break;
    case 4:
      text.erase(at, below(80, random));
      break;
    default:
      if (below(8, random) == 0) text.resize(at);
  }
}

TEST(Fuzz, MutatedScenesAreReadOrRefusedButNeverCrash) {
  const TemporaryFolder folder;
  folder.write("packing.txt", "0.05 0.05 0.05 0.005\n0.1 0.05 0.05 0.005\n");
  ASSERT_EQ(texts_of(mistakes_in(valid, {}, folder.path())), std::vector<std::string>());
  Random random(20240229);
  int refused = 0;
  for (int round = 0; round < 1500; ++round) {
    std::string text(valid);
    for (std::size_t k = 0; k < 1 + below(4, random); ++k) mutate(text, random);
    SCOPED_TRACE(text);
    // Anything but an InputError would end the test.
    refused += mistakes_in(text, {}, folder.path()).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 500);
}

/// What a scene said, without its balls, is a scene document again and says the same.
TEST(Fuzz, TheDocumentOfAMutatedSceneIsReadAgain) {
  const TemporaryFolder folder;
  folder.write("packing.txt", "0.05 0.05 0.05 0.005\n0.1 0.05 0.05 0.005\n");
  Random random(20240301);
  int read = 0;
  for (int round = 0; round < 1000; ++round) {
    std::string text(valid);
    mutate(text, random);
    SCOPED_TRACE(text);
    if (!mistakes_in(text, {}, folder.path()).empty()) continue;
    ++read;
    const model::Scene scene = read_scene_text(text, folder.path());
    const model::Scene again =
        read_settings_text(scene.document, folder.path(), "settings", {}, scene.bodies.material);
    EXPECT_EQ(again.document, scene.document);
    EXPECT_EQ(again.gravity, scene.gravity);
    EXPECT_EQ(again.contacts.size(), scene.contacts.size());
    EXPECT_EQ(again.notes, scene.notes);
  }
  EXPECT_GT(read, 100);
}

TEST(Fuzz, OddTexts) {
  for (const std::string_view text : {"",
                                      "\n",
                                      "~",
                                      "[]",
                                      "5",
                                      "- a",
                                      "? [a]\n: b",
                                      "{a: {a: {a: {a: 1}}}}",
                                      "&a [*a]",
                                      "a: &b {c: *b}",
                                      "!!int a: b",
                                      "%YAML 9.9\n---\na",
                                      "--- a\n--- b\n",
                                      "\xff\xfe\x00\x00",
                                      "a: b: c",
                                      "\t",
                                      "{",
                                      "[",
                                      "'",
                                      "\"",
                                      "|",
                                      "&",
                                      "*",
                                      "!",
                                      "!3",
                                      "- - - -",
                                      "{?",
                                      "[?",
                                      "[a: b, ? c]",
                                      ": a",
                                      "? ",
                                      "<<: *a",
                                      "balls: *b",
                                      "a: |\n b\n  c\n d",
                                      "...",
                                      "balls:\n",
                                      "materials: [~]",
                                      "materials: [[]]",
                                      "gravity: {}",
                                      "walls: [{plane: ~, box: ~}]"}) {
    SCOPED_TRACE(text);
    EXPECT_FALSE(mistakes_in(text).empty());
  }
  EXPECT_FALSE(mistakes_in(std::string(100'000, '[')).empty());
  EXPECT_FALSE(mistakes_in(std::string(100'000, '{')).empty());
}

TEST(Fuzz, AliasesThatUnfoldToBillionsOfNodesAreRefused) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int k = 1; k < 12; ++k) {
    text += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [";
    for (int j = 0; j < 10; ++j) text += (j > 0 ? ", *a" : "*a") + std::to_string(k - 1);
    text += "]\n";
  }
  const std::vector<Mistake> mistakes = mistakes_in(text);
  ASSERT_EQ(mistakes.size(), 1U);
  EXPECT_THAT(mistakes[0].message, testing::HasSubstr("aliases repeat too much"));
}

}  // namespace
}  // namespace eigengrain::io
