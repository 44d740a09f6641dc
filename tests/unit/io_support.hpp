#pragma once

#include "eigengrain/base/error.hpp"
#include "eigengrain/io/scene_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::io {

/// A folder of its own for a test, gone at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "eigengrain-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(std::string_view name, std::string_view text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// The mistakes in a scene text; none if it can be read.
inline std::vector<Mistake> mistakes_in(std::string_view yaml, const std::vector<std::string>& overrides = {},
                                        const std::filesystem::path& folder = ".") {
  try {
    read_scene_text(yaml, folder, "scene.yaml", overrides);
  } catch (const InputError& error) {
    return error.mistakes();
  }
  return {};
}

/// Each mistake as the user sees it.
inline std::vector<std::string> texts_of(const std::vector<Mistake>& mistakes) {
  std::vector<std::string> texts;
  for (const Mistake& mistake : mistakes) texts.push_back(mistake.text());
  return texts;
}

}  // namespace eigengrain::io
