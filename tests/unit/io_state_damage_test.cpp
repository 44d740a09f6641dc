#include "io/state_layout.hpp"
#include "unit/io_state_support.hpp"

#include <fmt/format.h>

namespace eigengrain::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A state file in a folder of its own.
class StateDamage : public testing::Test {
 protected:
  StateDamage() : state_(arbitrary_state(busy())), file_(folder_.path() / "state.h5") {
    write_state(state_, file_);
    whole_ = contents(file_);
  }
  /// Removed first: to overwrite a file waits for the disk.
  std::filesystem::path replaced(std::string_view name, std::string_view text) const {
    std::filesystem::remove(folder_.path() / name);
    return folder_.write(name, text);
  }
  /// What is said to the file after a change of its HDF5 part.
  std::string after(const std::function<void(hid_t)>& change) {
    replaced("state.h5", whole_);
    rewrite(file_, change);
    return refusal(file_);
  }
  /// What is said after one number of a dataset was changed.
  template <class T>
  std::string with_value(const char* path, hid_t type, std::size_t at, T value) {
    return after([&](hid_t id) {
      const hid_t dataset = H5Dopen2(id, path, H5P_DEFAULT);
      std::vector<T> values(1000);
      ASSERT_GE(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
      values[at] = value;
      ASSERT_GE(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
      H5Dclose(dataset);
    });
  }

  TemporaryFolder folder_;
  assembly::State state_;
  std::filesystem::path file_;
  std::string whole_;
};

TEST_F(StateDamage, OrientationsThatAreNoRotations) {
  state_.model.bodies.orientation.assign(state_.model.bodies.position.size(), Quat::Identity());
  write_state(state_, file_);
  whole_ = contents(file_);
  EXPECT_EQ(after([](hid_t) {}), "");
  EXPECT_THAT(with_value("/bodies/orientation", H5T_NATIVE_DOUBLE, 3, 0.5),
              HasSubstr("is no unit quaternion"));
}

TEST_F(StateDamage, WhatIsNoState) {
  EXPECT_THAT(refusal(folder_.path() / "stat.h5"),
              AllOf(HasSubstr("there is no file"), HasSubstr("did you mean \"state.h5\"")));
  EXPECT_THAT(refusal(folder_.path()), HasSubstr("a folder"));
  const auto scene = folder_.write("scene.yaml", "balls: []\n");
  EXPECT_THAT(refusal(scene), AllOf(HasSubstr("scene.yaml: no state file"), HasSubstr("HDF5")));
  EXPECT_FALSE(is_state_file(scene));
  EXPECT_FALSE(is_state_file(folder_.path() / "nowhere"));
  EXPECT_FALSE(is_state_file(folder_.path()));
  const auto empty = folder_.write("empty.h5", "");
  EXPECT_THAT(refusal(empty), HasSubstr("no state file"));
  const auto other = folder_.path() / "other.h5";
  H5Fclose(H5Fcreate(other.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  EXPECT_THAT(refusal(other), HasSubstr("no state of Eigengrain"));
}

TEST_F(StateDamage, OtherSchemas) {
  const auto with_schema = [&](std::int64_t schema) {
    return after([&](hid_t id) {
      H5Adelete(id, "schema");
      const hid_t space = H5Screate(H5S_SCALAR);
      const hid_t attribute = H5Acreate2(id, "schema", H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT);
      H5Awrite(attribute, H5T_NATIVE_INT64, &schema);
      H5Aclose(attribute);
      H5Sclose(space);
    });
  };
  EXPECT_THAT(with_schema(layout::schema + 1), HasSubstr("written by a newer version"));
  EXPECT_THAT(with_schema(0), HasSubstr("no schema that exists"));
  EXPECT_EQ(with_schema(1), "");
  EXPECT_EQ(with_schema(3), "");
}

TEST_F(StateDamage, MissingParts) {
  std::vector<std::string> paths{"/settings", "/bodies", "/contacts", "/contacts/0", "/neighbour_list"};
  for (const char* column :
       {"identity", "position", "radius", "mass", "inertia", "material", "fixed", "velocity", "force"})
    paths.push_back(fmt::format("/bodies/{}", column));
  for (const char* column : {"a", "b", "image", "shear_force", "normal"})
    paths.push_back(fmt::format("/contacts/0/{}", column));
  paths.emplace_back("/neighbour_list/position");
  for (const std::string& path : paths)
    EXPECT_THAT(after([&](hid_t id) { H5Ldelete(id, path.c_str(), H5P_DEFAULT); }),
                AllOf(HasSubstr("state.h5: "), HasSubstr("there is no "), HasSubstr(path)));
  for (const char* attribute : {"time", "step", "dt", "next_dt", "scene"})
    EXPECT_THAT(after([&](hid_t id) { H5Adelete(id, attribute); }), HasSubstr(attribute));
}

TEST_F(StateDamage, WrongShapes) {
  const std::vector<std::pair<std::string, hid_t>> columns{{"/bodies/position", H5T_IEEE_F64LE},
                                                           {"/bodies/radius", H5T_IEEE_F64LE},
                                                           {"/bodies/spin", H5T_IEEE_F64LE},
                                                           {"/bodies/identity", H5T_STD_I64LE},
                                                           {"/contacts/0/b", H5T_STD_I32LE},
                                                           {"/contacts/0/normal", H5T_IEEE_F64LE},
                                                           {"/neighbour_list/position", H5T_IEEE_F64LE}};
  for (const auto& [path, type] : columns)
    for (const hsize_t rows : {1, 100'000'000}) {
      const auto replace = [&, path = path, type = type](hid_t id) {
        H5Ldelete(id, path.c_str(), H5P_DEFAULT);
        const hid_t space = H5Screate_simple(1, &rows, nullptr);
        H5Dclose(H5Dcreate2(id, path.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
        H5Sclose(space);
      };
      EXPECT_THAT(after(replace), HasSubstr("shape")) << path;
    }
}

TEST_F(StateDamage, ImpossibleNumbers) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(with_value("/bodies/position", H5T_NATIVE_DOUBLE, 7, nan), HasSubstr("not finite"));
  EXPECT_THAT(with_value("/bodies/radius", H5T_NATIVE_DOUBLE, 3, 0.0), HasSubstr("not positive"));
  EXPECT_THAT(with_value("/bodies/radius", H5T_NATIVE_DOUBLE, 3, nan), HasSubstr("not positive"));
  EXPECT_THAT(with_value("/bodies/material", H5T_NATIVE_INT32, 3, 4), HasSubstr("more materials"));
  EXPECT_THAT(with_value("/bodies/material", H5T_NATIVE_INT32, 3, -1), HasSubstr("materials"));
  for (const std::int32_t index : {-1, 72, 2'000'000'000}) {
    EXPECT_THAT(with_value("/contacts/0/a", H5T_NATIVE_INT32, 2, index), HasSubstr("there are 72 balls"));
    EXPECT_THAT(with_value("/contacts/0/b", H5T_NATIVE_INT32, 2, index), HasSubstr("there are 72 balls"));
  }
  EXPECT_THAT(with_value("/contacts/0/image", H5T_NATIVE_INT8, 1, std::int8_t{1}),
              HasSubstr("does not repeat"));
}

TEST_F(StateDamage, CutShort) {
  std::mt19937_64 random(3);
  std::vector<std::size_t> lengths;
  for (std::size_t length = 0; length < 300; ++length) lengths.push_back(length);
  for (std::size_t length = whole_.size() - 60; length < whole_.size(); ++length) lengths.push_back(length);
  for (int k = 0; k < 150; ++k) lengths.push_back(random() % whole_.size());
  for (const std::size_t length : lengths) {
    EXPECT_NE(refusal(replaced("cut.h5", std::string_view(whole_).substr(0, length))), "") << length;
  }
  folder_.write("long.h5", whole_ + '\0');
  EXPECT_NE(refusal(folder_.path() / "long.h5"), "");
}

TEST_F(StateDamage, AFlippedByte) {
  std::mt19937_64 random(5);
  std::vector<std::size_t> places;
  for (std::size_t at = 0; at < 200; ++at) places.push_back(at);
  for (std::size_t at = whole_.size() - 40; at < whole_.size(); ++at) places.push_back(at);
  for (int k = 0; k < 600; ++k) places.push_back(random() % whole_.size());
  for (const std::size_t at : places) {
    std::string damaged = whole_;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
    EXPECT_NE(refusal(replaced("damaged.h5", damaged)), "") << at;
  }
}

/// Where the seal is lost as well, HDF5 itself is the judge: it may not crash, nor may the file pass.
TEST_F(StateDamage, WithoutASeal) {
  folder_.write("unsealed.h5", std::string_view(whole_).substr(0, whole_.size() - 20));
  EXPECT_THAT(refusal(folder_.path() / "unsealed.h5"), HasSubstr("checksum at its end is missing"));
}

/// Expected values from Python: zlib.crc32(text + b"EGR-SEAL" + len(text).to_bytes(8, "little")).
TEST(Seal, HasTheCrcThatOthersCompute) {
  const TemporaryFolder folder;
  for (const auto& [text, crc] : {std::pair<std::string, std::uint32_t>{"", 2121634233U},
                                  std::pair<std::string, std::uint32_t>{"123456789", 366999062U}}) {
    const auto file = folder.write("text", text);
    seal(file);
    EXPECT_EQ(check_seal(file), Seal::intact);
    const std::string sealed = contents(file);
    ASSERT_EQ(sealed.size(), text.size() + 20);
    std::uint32_t found = 0;
    std::memcpy(&found, &sealed[text.size() + 16], sizeof found);
    EXPECT_EQ(found, crc);
  }
}

}  // namespace
}  // namespace eigengrain::io
