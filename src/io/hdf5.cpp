#include "hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>

#define EIGENGRAIN_HDF5(call) ::eigengrain::io::h5::check((call), #call)

namespace eigengrain::io::h5 {
namespace {

using Space = Owner<H5Sclose>;
using Dataset = Owner<H5Dclose>;
using Type = Owner<H5Tclose>;
using Attribute = Owner<H5Aclose>;
using Properties = Owner<H5Pclose>;
using Group = Owner<H5Gclose>;

hid_t type_in_file(Number number) {
  switch (number) {
    case Number::f64:
      return H5T_IEEE_F64LE;
    case Number::i64:
      return H5T_STD_I64LE;
    case Number::i32:
      return H5T_STD_I32LE;
    case Number::i8:
      return H5T_STD_I8LE;
    case Number::u8:
      return H5T_STD_U8LE;
  }
  return -1;
}

hid_t type_in_memory(Number number) {
  switch (number) {
    case Number::f64:
      return H5T_NATIVE_DOUBLE;
    case Number::i64:
      return H5T_NATIVE_INT64;
    case Number::i32:
      return H5T_NATIVE_INT32;
    case Number::i8:
      return H5T_NATIVE_INT8;
    case Number::u8:
      return H5T_NATIVE_UINT8;
  }
  return -1;
}

Space scalar() {
  return Space(EIGENGRAIN_HDF5(H5Screate(H5S_SCALAR)));
}

/// HDF5 has no text of length zero: an empty one is one NUL, which reading takes off again.
Type text_type(std::size_t length) {
  Type type(EIGENGRAIN_HDF5(H5Tcopy(H5T_C_S1)));
  EIGENGRAIN_HDF5(H5Tset_size(type.get(), std::max<std::size_t>(length, 1)));
  EIGENGRAIN_HDF5(H5Tset_strpad(type.get(), H5T_STR_NULLPAD));
  EIGENGRAIN_HDF5(H5Tset_cset(type.get(), H5T_CSET_UTF8));
  return type;
}

/// Room for a text of that type; fails if it is none, or not of one fixed length.
std::string room_for(const Type& type, std::string_view what) {
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0)
    throw Error(fmt::format("{} is not a text", what));
  return std::string(H5Tget_size(type.get()), '\0');
}

std::string without_padding(std::string text) {
  text.erase(std::min(text.find_last_not_of('\0') + 1, text.size()));
  return text;
}

/// Files change by renaming only, so they need no locks, and some file systems have none.
Properties access() {
  Properties properties(EIGENGRAIN_HDF5(H5Pcreate(H5P_FILE_ACCESS)));
  EIGENGRAIN_HDF5(H5Pset_file_locking(properties.get(), false, true));
  return properties;
}

/// No times in the headers: files of equal states are equal but for their date.
Dataset create_dataset(hid_t file, const std::string& path, hid_t type, const Space& space) {
  const Properties properties(EIGENGRAIN_HDF5(H5Pcreate(H5P_DATASET_CREATE)));
  EIGENGRAIN_HDF5(H5Pset_obj_track_times(properties.get(), false));
  return Dataset(EIGENGRAIN_HDF5(
      H5Dcreate2(file, path.c_str(), type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT)));
}

Dataset open_dataset(const File& file, const std::string& path) {
  const hid_t id = H5Dopen2(file.id(), path.c_str(), H5P_DEFAULT);
  if (id < 0) throw Error(fmt::format("there is no dataset {}", path));
  return Dataset(id);
}

std::string shape_text(std::span<const hsize_t> shape) {
  std::string text;
  for (const hsize_t length : shape) text += fmt::format("{}{}", text.empty() ? "" : "×", length);
  return text.empty() ? "a single value" : text;
}

std::vector<hsize_t> shape_of(const Dataset& dataset) {
  const Space space(EIGENGRAIN_HDF5(H5Dget_space(dataset.get())));
  std::vector<hsize_t> shape(
      static_cast<std::size_t>(EIGENGRAIN_HDF5(H5Sget_simple_extent_ndims(space.get()))));
  EIGENGRAIN_HDF5(H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr));
  return shape;
}

std::vector<hsize_t> shape_of(std::size_t rows, int components) {
  std::vector<hsize_t> shape{rows};
  if (components > 1) shape.push_back(static_cast<hsize_t>(components));
  return shape;
}

void write_attribute(hid_t file, const std::string& path, const char* name, hid_t type_in_file,
                     hid_t type_in_memory, const void* value) {
  const Attribute attribute(EIGENGRAIN_HDF5(H5Acreate_by_name(
      file, path.c_str(), name, type_in_file, scalar().get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)));
  EIGENGRAIN_HDF5(H5Awrite(attribute.get(), type_in_memory, value));
}

/// An attribute that is one value.
Attribute open_attribute(const File& file, const std::string& path, const char* name) {
  const hid_t id = H5Aopen_by_name(file.id(), path.c_str(), name, H5P_DEFAULT, H5P_DEFAULT);
  if (id < 0) throw Error(fmt::format("there is no attribute \"{}\" of {}", name, path));
  Attribute attribute(id);
  const Space space(EIGENGRAIN_HDF5(H5Aget_space(id)));
  if (H5Sget_simple_extent_npoints(space.get()) != 1)
    throw Error(fmt::format("the attribute \"{}\" of {} is not a single value", name, path));
  return attribute;
}

template <class T>
T read_attribute(const File& file, const std::string& path, const char* name, Number number) {
  const Attribute attribute = open_attribute(file, path, name);
  const Type type(EIGENGRAIN_HDF5(H5Aget_type(attribute.get())));
  if (H5Tequal(type.get(), type_in_file(number)) <= 0)
    throw Error(fmt::format("the attribute \"{}\" of {} is of another type", name, path));
  T value{};
  EIGENGRAIN_HDF5(H5Aread(attribute.get(), type_in_memory(number), &value));
  return value;
}

}  // namespace

void fail(std::string_view call) {
  std::string reason;
  // Upward: the first is the innermost, which knows what happened.
  const auto take_first = [](unsigned /*depth*/, const H5E_error2_t* error, void* data) -> herr_t {
    auto& text = *static_cast<std::string*>(data);
    if (text.empty() && error->desc != nullptr) text = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &reason);
  throw Error(fmt::format("{} failed: {}", call.substr(0, call.find('(')), reason));
}

Silence::Silence() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Silence::~Silence() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

File File::create_in_memory(std::size_t increment) {
  const Properties properties(EIGENGRAIN_HDF5(H5Pcreate(H5P_FILE_ACCESS)));
  EIGENGRAIN_HDF5(H5Pset_fapl_core(properties.get(), increment, false));
  return File(EIGENGRAIN_HDF5(H5Fcreate("memory", H5F_ACC_TRUNC, H5P_DEFAULT, properties.get())));
}

File File::open(const std::filesystem::path& file) {
  return File(EIGENGRAIN_HDF5(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access().get())));
}

std::span<const char> File::image() const {
  EIGENGRAIN_HDF5(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL));
  const auto size = EIGENGRAIN_HDF5(H5Fget_file_image(file_.get(), nullptr, 0));
  void* handle = nullptr;  // of the driver for memory: where it keeps the address of the file
  EIGENGRAIN_HDF5(H5Fget_vfd_handle(file_.get(), H5P_DEFAULT, &handle));
  return {*static_cast<const char**>(handle), static_cast<std::size_t>(size)};
}

void File::add_group(const std::string& path) {
  const Group group(
      EIGENGRAIN_HDF5(H5Gcreate2(file_.get(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)));
}

bool File::has(const std::string& path) const {
  return H5Lexists(file_.get(), path.c_str(), H5P_DEFAULT) > 0;
}

void File::write_rows(const std::string& path, Number number, const void* data, std::size_t rows,
                      int components) {
  const std::vector<hsize_t> shape = shape_of(rows, components);
  const Space space(EIGENGRAIN_HDF5(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr)));
  const Dataset dataset = create_dataset(file_.get(), path, type_in_file(number), space);
  if (rows == 0) return;
  EIGENGRAIN_HDF5(H5Dwrite(dataset.get(), type_in_memory(number), H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
}

void File::write_text(const std::string& path, std::string_view text) {
  const Type type = text_type(text.size());
  const Dataset dataset = create_dataset(file_.get(), path, type.get(), scalar());
  const std::string padded = text.empty() ? std::string(1, '\0') : std::string(text);
  EIGENGRAIN_HDF5(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()));
}

std::vector<double> File::read_doubles(const std::string& path, std::size_t rows, int components) const {
  require_rows(path, Number::f64, rows, components);
  std::vector<double> values(rows * static_cast<std::size_t>(components));
  read_rows(path, Number::f64, values.data(), rows);
  return values;
}

std::string File::read_text(const std::string& path) const {
  const Dataset dataset = open_dataset(*this, path);
  if (!shape_of(dataset).empty()) throw Error(fmt::format("{} is not a single text", path));
  const Type type(EIGENGRAIN_HDF5(H5Dget_type(dataset.get())));
  std::string text = room_for(type, path);
  EIGENGRAIN_HDF5(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()));
  return without_padding(std::move(text));
}

std::size_t File::rows(const std::string& path) const {
  const std::vector<hsize_t> shape = shape_of(open_dataset(*this, path));
  return shape.empty() ? 0 : shape[0];
}

void File::require_rows(const std::string& path, Number number, std::size_t rows, int components) const {
  const Dataset dataset = open_dataset(*this, path);
  const Type type(EIGENGRAIN_HDF5(H5Dget_type(dataset.get())));
  if (H5Tequal(type.get(), type_in_file(number)) <= 0)
    throw Error(fmt::format("the dataset {} is of another type", path));
  const std::vector<hsize_t> shape = shape_of(dataset);
  const std::vector<hsize_t> wanted = shape_of(rows, components);
  if (shape != wanted)
    throw Error(
        fmt::format("the dataset {} has the shape {}, not {}", path, shape_text(shape), shape_text(wanted)));
}

void File::read_rows(const std::string& path, Number number, void* data, std::size_t rows) const {
  if (rows == 0) return;
  const Dataset dataset = open_dataset(*this, path);
  EIGENGRAIN_HDF5(H5Dread(dataset.get(), type_in_memory(number), H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
}

void File::set(const std::string& path, const char* attribute, double value) {
  write_attribute(file_.get(), path, attribute, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

void File::set(const std::string& path, const char* attribute, std::int64_t value) {
  write_attribute(file_.get(), path, attribute, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

void File::set(const std::string& path, const char* attribute, std::string_view value) {
  const Type type = text_type(value.size());
  const std::string padded = value.empty() ? std::string(1, '\0') : std::string(value);
  write_attribute(file_.get(), path, attribute, type.get(), type.get(), padded.data());
}

bool File::has_attribute(const std::string& path, const char* attribute) const {
  return H5Aexists_by_name(file_.get(), path.c_str(), attribute, H5P_DEFAULT) > 0;
}

double File::number(const std::string& path, const char* attribute) const {
  return read_attribute<double>(*this, path, attribute, Number::f64);
}

std::int64_t File::integer(const std::string& path, const char* attribute) const {
  return read_attribute<std::int64_t>(*this, path, attribute, Number::i64);
}

std::string File::text(const std::string& path, const char* name) const {
  const Attribute attribute = open_attribute(*this, path, name);
  const Type type(EIGENGRAIN_HDF5(H5Aget_type(attribute.get())));
  std::string text = room_for(type, fmt::format("the attribute \"{}\" of {}", name, path));
  EIGENGRAIN_HDF5(H5Aread(attribute.get(), type.get(), text.data()));
  return without_padding(std::move(text));
}

}  // namespace eigengrain::io::h5
