#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/bodies.hpp"
#include "eigengrain/model/surroundings.hpp"

#include <hdf5.h>

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// What little of HDF5 state files need: numbers in rows, texts and attributes, each under its path.
namespace eigengrain::io::h5 {

/// A call of HDF5 that failed, with the library's own description, or contents that are not those asked for.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

[[noreturn]] void fail(std::string_view call);

/// The one place where HDF5's error codes become exceptions.
template <std::signed_integral Code>
Code check(Code code, std::string_view call) {
  if (code < 0) fail(call);
  return code;
}

/// HDF5 prints its errors by itself unless told otherwise; restored at the end, for it may have other users.
class Silence {
 public:
  Silence();
  ~Silence();
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Move-only owner of a handle; `close` is the call that gives it back.
template <herr_t (*close)(hid_t)>
class Owner {
 public:
  explicit Owner(hid_t id) : id_(id) {}
  ~Owner() {
    if (id_ >= 0) close(id_);
  }
  Owner(Owner&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Owner& operator=(Owner&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  Owner(const Owner&) = delete;
  Owner& operator=(const Owner&) = delete;

  hid_t get() const { return id_; }

 private:
  hid_t id_;
};

/// The types of numbers in files, all little-endian.
enum class Number { f64, i64, i32, i8, u8 };

/// How a row of a column stands in memory: so many numbers of one type.
template <class T>
struct Row;
template <>
struct Row<double> {
  static constexpr Number number = Number::f64;
  static constexpr int components = 1;
};
template <>
struct Row<std::int64_t> {
  static constexpr Number number = Number::i64;
  static constexpr int components = 1;
};
template <>
struct Row<std::int32_t> {
  static constexpr Number number = Number::i32;
  static constexpr int components = 1;
};
template <>
struct Row<std::int8_t> {
  static constexpr Number number = Number::i8;
  static constexpr int components = 1;
};
template <>
struct Row<Vec3> {
  static constexpr Number number = Number::f64;
  static constexpr int components = 3;
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
};
template <>
struct Row<Quat> {
  static constexpr Number number = Number::f64;
  static constexpr int components = 4;
  static_assert(sizeof(Quat) == 4 * sizeof(double));
};
template <>
struct Row<model::RadiusRamp> {
  static constexpr Number number = Number::f64;
  static constexpr int components = 6;
  static_assert(sizeof(model::RadiusRamp) == 6 * sizeof(double));
};
template <>
struct Row<model::Image> {
  static constexpr Number number = Number::i8;
  static constexpr int components = 3;
  static_assert(sizeof(model::Image) == 3);
};
template <>
struct Row<model::FixedComponents> {
  static constexpr Number number = Number::u8;
  static constexpr int components = 1;
  static_assert(sizeof(model::FixedComponents) == 1);
};

/// An open file. Paths begin at its root, as in "/bodies/position".
class File {
 public:
  /// A new file that is in memory only: where a disk is full, HDF5 fails to close a file and crashes when the
  /// program ends (seen with 1.10.8), so it never gets to write on one. Memory grows by so many bytes.
  static File create_in_memory(std::size_t increment);
  static File open(const std::filesystem::path& file);
  hid_t id() const { return file_.get(); }

  /// All of a file in memory as it would be on a disk; until something else is written or it is closed.
  std::span<const char> image() const;

  void add_group(const std::string& path);
  /// Whether something stands there; its group has to exist.
  bool has(const std::string& path) const;

  template <class T>
  void write(const std::string& path, const std::vector<T>& column) {
    write_rows(path, Row<T>::number, column.data(), column.size(), Row<T>::components);
  }
  /// [rows × components], row after row; [rows] with one component.
  void write_rows(const std::string& path, Number number, const void* data, std::size_t rows, int components);
  void write_text(const std::string& path, std::string_view text);

  /// A column with so many rows.
  template <class T>
  std::vector<T> read(const std::string& path, std::size_t rows) const {
    require_rows(path, Row<T>::number, rows, Row<T>::components);
    std::vector<T> column(rows);
    read_rows(path, Row<T>::number, column.data(), rows);
    return column;
  }
  std::vector<double> read_doubles(const std::string& path, std::size_t rows, int components) const;
  std::string read_text(const std::string& path) const;
  /// Rows of a dataset, whatever it holds.
  std::size_t rows(const std::string& path) const;

  void set(const std::string& path, const char* attribute, double value);
  void set(const std::string& path, const char* attribute, std::int64_t value);
  void set(const std::string& path, const char* attribute, std::string_view value);
  bool has_attribute(const std::string& path, const char* attribute) const;
  double number(const std::string& path, const char* attribute) const;
  std::int64_t integer(const std::string& path, const char* attribute) const;
  std::string text(const std::string& path, const char* attribute) const;

 private:
  explicit File(hid_t id) : file_(id) {}
  void require_rows(const std::string& path, Number number, std::size_t rows, int components) const;
  void read_rows(const std::string& path, Number number, void* data, std::size_t rows) const;

  Owner<H5Fclose> file_;
};

}  // namespace eigengrain::io::h5
