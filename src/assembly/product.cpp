#include "eigengrain/assembly/product.hpp"

#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/base/type_list.hpp"

#include "processor.hpp"
#include "product_records.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <new>
#include <utility>

namespace eigengrain::assembly {
namespace product {

extern const Kernel product_kernel_baseline;
#ifdef EIGENGRAIN_KERNEL_AVX2
extern const Kernel product_kernel_avx2;
#endif

const Kernel& best_kernel() {
#ifdef EIGENGRAIN_KERNEL_AVX2
  if (runs_avx2_kernels()) return product_kernel_avx2;
#endif
  return product_kernel_baseline;
}

}  // namespace product

namespace {

using contact::ContactElement;
using contact::no_body;
using product::BallRecord;
using product::CentralRecord;
using product::Chunk;
using product::GeneralRecord;
using product::Records;

/// Doubles on cache-line boundaries.
class PaddedVector {
 public:
  explicit PaddedVector(std::size_t size)
      : size_(size), data_(static_cast<double*>(::operator new(size * sizeof(double), alignment))) {
    std::fill_n(data_.get(), size_, 0.0);
  }
  double* data() { return data_.get(); }
  std::size_t size() const { return size_; }

 private:
  static constexpr std::align_val_t alignment{64};
  struct Free {
    void operator()(double* p) const { ::operator delete(p, alignment); }
  };
  std::size_t size_;
  std::unique_ptr<double, Free> data_;
};

/// The kinds of record, from the special to the general.
enum class Kind { central, ball, general };

/// Whether the lever is along n (to rounding: it is a product of n), so that a BallRecord can hold it.
bool along(const Vec3& lever, const Vec3& n) {
  return lever.cross(n).norm() <= 1e-15 * lever.norm();
}

Kind kind_of(const ContactElement& e) {
  const contact::ContactStiffness& k = e.stiffness;
  if (k.twist != 0 || k.bending != 0) return Kind::general;
  const bool radial = along(e.lever_a, e.normal) && (e.b == no_body || along(e.lever_b, e.normal));
  if (!radial) return Kind::general;
  return k.shear == 0 ? Kind::central : Kind::ball;
}

/// The contact as its other end sees it.
ContactElement with_ends_swapped(const ContactElement& e) {
  return {e.b, e.a, -e.normal, e.lever_b, e.lever_a, e.stiffness};
}

void copy(const Vec3& from, double* to) {
  std::copy_n(from.data(), 3, to);
}

CentralRecord record(const ContactElement& e, TypeTag<CentralRecord>) {
  CentralRecord r{};
  copy(std::sqrt(e.stiffness.normal) * e.normal, r.scaled_normal);
  return r;
}

BallRecord record(const ContactElement& e, TypeTag<BallRecord>) {
  BallRecord r{};
  copy(e.normal, r.normal);
  r.shear = e.stiffness.shear;
  r.normal_excess = e.stiffness.normal - e.stiffness.shear;
  r.near = e.lever_a.dot(e.normal);
  r.far = -e.lever_b.dot(e.normal);
  return r;
}

GeneralRecord record(const ContactElement& e, TypeTag<GeneralRecord>) {
  GeneralRecord r{};
  copy(e.normal, r.normal);
  copy(e.lever_a, r.lever_near);
  copy(e.lever_b, r.lever_far);
  r.shear = e.stiffness.shear;
  r.normal_excess = e.stiffness.normal - e.stiffness.shear;
  r.bending = e.stiffness.bending;
  r.twist_excess = e.stiffness.twist - e.stiffness.bending;
  return r;
}

/// Kinds of all elements: each is asked for several times, and takes a root.
std::vector<Kind> kinds_of(std::span<const ContactElement> elements) {
  std::vector<Kind> kinds(elements.size());
  for_each_index(std::ssize(elements), [&](std::int64_t c) { kinds[c] = kind_of(elements[c]); });
  return kinds;
}

/// Bodies a chunk: some tens of chunks for threads to share, few contacts between them, and sums that stay in
/// a processor's own cache.
std::int32_t chunk_size(std::int32_t bodies) {
  return std::clamp(bodies / 16, 512, 8192);
}

/// One end of a contact that a chunk evaluates: the element with this end near, and which list it goes to.
struct Visit {
  std::int32_t element;
  bool swapped;
  bool inner;
};

/// Visits of every body, grouped by body: an inner contact once, any other once for each movable end.
class Visits {
 public:
  Visits(const Unknowns& unknowns, std::int32_t bodies, std::span<const ContactElement> elements)
      : offsets_(static_cast<std::size_t>(bodies) + 1, 0) {
    const std::int32_t size = chunk_size(bodies);
    const auto moves = [&](std::int32_t body) {
      return body != no_body &&
             (unknowns.translation(body) != Unknowns::none || unknowns.rotation(body) != Unknowns::none);
    };
    const auto each_visit = [&](const auto& act) {
      for (std::size_t c = 0; c < elements.size(); ++c) {
        const auto index = static_cast<std::int32_t>(c);
        const ContactElement& e = elements[c];
        const bool a = moves(e.a);
        const bool b = moves(e.b);
        if (a && b && e.a / size == e.b / size) {
          act(e.a, Visit{index, false, true});
          continue;
        }
        if (a) act(e.a, Visit{index, false, false});
        if (b) act(e.b, Visit{index, true, false});
      }
    };
    each_visit([&](std::int32_t body, const Visit&) { ++offsets_[static_cast<std::size_t>(body) + 1]; });
    for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
    visits_.resize(static_cast<std::size_t>(offsets_.back()));
    std::vector<std::int64_t> next(offsets_.begin(), offsets_.end() - 1);
    each_visit([&](std::int32_t body, const Visit& visit) {
      visits_[static_cast<std::size_t>(next[body]++)] = visit;
    });
  }
  std::span<const Visit> of(std::int32_t body) const {
    const auto i = static_cast<std::size_t>(body);
    return std::span(visits_).subspan(static_cast<std::size_t>(offsets_[i]),
                                      static_cast<std::size_t>(offsets_[i + 1] - offsets_[i]));
  }

 private:
  std::vector<std::int64_t> offsets_;
  std::vector<Visit> visits_;
};

/// Fills the lists of one kind of record. `nobody` stands for the far end at a wall.
template <class Record>
Records<Record> make_records(const Chunk& chunk, Kind kind, const Visits& visits,
                             std::span<const ContactElement> elements, std::span<const Kind> kinds,
                             std::int32_t nobody) {
  const auto each_visit = [&](const auto& act) {
    for (std::int32_t body = chunk.first_body; body < chunk.last_body; ++body)
      for (const Visit& visit : visits.of(body))
        if (kinds[visit.element] == kind) act(visit);
  };
  std::size_t inner = 0;
  std::size_t cut = 0;
  each_visit([&](const Visit& visit) { ++(visit.inner ? inner : cut); });
  Records<Record> result;
  result.inner.reserve(inner);
  result.cut.reserve(cut);
  each_visit([&](const Visit& visit) {
    const ContactElement& e = elements[visit.element];
    Record r = visit.swapped ? record(with_ends_swapped(e), TypeTag<Record>{}) : record(e, TypeTag<Record>{});
    r.near_body = visit.swapped ? e.b : e.a;
    r.far_body = visit.swapped ? e.a : e.b;
    if (r.far_body == no_body) r.far_body = nobody;
    (visit.inner ? result.inner : result.cut).push_back(r);
  });
  return result;
}

/// A thread's sums of the chunk that it works on. They live as long as the thread, so that a product
/// allocates nothing and its sums stay in the processor's cache from one chunk to the next.
double* zeroed_sums(std::size_t size) {
  thread_local PaddedVector sums(64);
  if (sums.size() < size) sums = PaddedVector(size);
  std::fill_n(sums.data(), size, 0.0);
  // NOLINTNEXTLINE(clang-analyzer-cplusplus.NewDelete): takes the thread's buffer for a local one
  return sums.data();
}

std::vector<double> full_scaling(const Unknowns& unknowns, std::span<const double> scale) {
  if (!scale.empty()) return {scale.begin(), scale.end()};
  std::vector<double> ones(static_cast<std::size_t>(unknowns.size()), 0.0);
  for (const std::int32_t number : unknowns.free_components()) ones[number] = 1.0;
  return ones;
}

product::Layout layout_of(const Unknowns& unknowns, bool turns, std::span<const double> scale) {
  product::Layout layout{.stride = turns ? product::rotation_stride : product::translation_stride,
                         .slot = {},
                         .scale = full_scaling(unknowns, scale)};
  layout.slot.reserve(static_cast<std::size_t>(unknowns.blocks()));
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block)
    layout.slot.push_back(layout.stride / 4 * unknowns.body(block) + (unknowns.is_rotation(block) ? 1 : 0));
  return layout;
}

/// Chunks with their bodies and blocks, still without records. Blocks are in the order of their bodies.
std::vector<Chunk> empty_chunks(const Unknowns& unknowns) {
  std::vector<Chunk> chunks;
  const std::int32_t size = chunk_size(unknowns.bodies());
  std::int32_t block = 0;
  for (std::int32_t first = 0; first < unknowns.bodies(); first += size) {
    Chunk& chunk = chunks.emplace_back();
    chunk.first_body = first;
    chunk.last_body = std::min(first + size, unknowns.bodies());
    chunk.first_block = block;
    while (block < unknowns.blocks() && unknowns.body(block) < chunk.last_body) ++block;
    chunk.last_block = block;
  }
  return chunks;
}

/// A θ that is not along the axes of space, and where it stands in a padded vector.
struct OwnAxes {
  std::int64_t place;
  Mat3 axes;  ///< columns in space
};

/// [chunks] of the blocks of each; empty where all are along the axes of space.
std::vector<std::vector<OwnAxes>> own_axes(const Unknowns& unknowns, const product::Layout& layout,
                                           const std::vector<Chunk>& chunks) {
  std::vector<std::vector<OwnAxes>> result;
  if (!unknowns.has_axes()) return result;
  for (const Chunk& chunk : chunks) {
    std::vector<OwnAxes>& found = result.emplace_back();
    for (std::int32_t block = chunk.first_block; block < chunk.last_block; ++block)
      if (unknowns.is_rotation(block))
        if (const Mat3* axes = unknowns.axes(unknowns.body(block)))
          found.push_back({std::int64_t{4} * layout.slot[static_cast<std::size_t>(block)], *axes});
  }
  return result;
}

std::int64_t bytes_of(const std::vector<Chunk>& chunks) {
  const auto bytes = [](const auto& records) {
    return (records.inner.size() + records.cut.size()) * sizeof(records.inner[0]);
  };
  std::size_t sum = 0;
  for (const Chunk& chunk : chunks) sum += bytes(chunk.central) + bytes(chunk.ball) + bytes(chunk.general);
  return static_cast<std::int64_t>(sum);
}

/// y += S A S x, row by row.
void add_nodal(const BlockMatrix& a, const std::vector<double>& scale, std::span<const double> x,
               std::span<double> y) {
  using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  for_each_index(a.block_rows, [&](std::int64_t row) {
    const auto r = static_cast<std::size_t>(row);
    if (a.offsets[r] == a.offsets[r + 1]) return;
    Vec3 sum = Vec3::Zero();
    for (auto k = static_cast<std::size_t>(a.offsets[r]); k < static_cast<std::size_t>(a.offsets[r + 1]);
         ++k) {
      const auto j = 3 * static_cast<std::size_t>(a.columns[k]);
      sum += Eigen::Map<const RowMajor3>(&a.values[9 * k]) *
             Vec3(scale[j] * x[j], scale[j + 1] * x[j + 1], scale[j + 2] * x[j + 2]);
    }
    for (std::size_t i = 0; i < 3; ++i) y[3 * r + i] += scale[3 * r + i] * sum[static_cast<Eigen::Index>(i)];
  });
}

}  // namespace

struct StiffnessProduct::Data {
  Data(product::Layout where, std::int32_t bodies, std::vector<Chunk> parts)
      : layout(std::move(where)),
        chunks(std::move(parts)),
        // One body more than there are: the one at rest behind walls.
        x(static_cast<std::size_t>(layout.stride) * (static_cast<std::size_t>(bodies) + 1)) {}

  /// Calls act(chunk) for all chunks, on all threads.
  template <class Act>
  void for_each_chunk(const Act& act) {
    for_chunks(std::ssize(chunks), 1, [&](std::int64_t c, std::int64_t, std::int64_t) { act(chunks[c]); });
  }

  /// The same with the number of the chunk.
  template <class Act>
  void for_each_numbered_chunk(const Act& act) {
    for_chunks(std::ssize(chunks), 1, [&](std::int64_t c, std::int64_t, std::int64_t) { act(c); });
  }
  /// x of a chunk from its own axes to those of space.
  void to_space(std::int64_t chunk) {
    for (const OwnAxes& own : axes[static_cast<std::size_t>(chunk)]) {
      Eigen::Map<Vec3> v(x.data() + own.place);
      v = (own.axes * v).eval();
    }
  }
  /// Sums of a chunk from the axes of space to their own.
  void to_own_axes(std::int64_t chunk, double* sums) const {
    const std::int64_t start =
        std::int64_t{layout.stride} * chunks[static_cast<std::size_t>(chunk)].first_body;
    for (const OwnAxes& own : axes[static_cast<std::size_t>(chunk)]) {
      Eigen::Map<Vec3> v(sums + (own.place - start));
      v = (own.axes.transpose() * v).eval();
    }
  }

  product::Layout layout;
  std::vector<Chunk> chunks;
  PaddedVector x;
  std::vector<std::vector<OwnAxes>> axes;  ///< [chunks], or empty
  const product::Kernel* kernel = &product::best_kernel();
  const BlockMatrix* nodal = nullptr;
  std::int64_t record_bytes = 0;
  std::int64_t products = 0;
};

StiffnessProduct::StiffnessProduct(const Unknowns& unknowns, const StiffnessParts& parts,
                                   std::span<const double> scale) {
  const std::span<const ContactElement> elements = parts.contacts;
  const std::int32_t bodies = unknowns.bodies();
  const std::vector<Kind> kinds = kinds_of(elements);
  // Contacts with shear read rotations even where every body holds its own; clumps have them without.
  const bool turns = unknowns.rotations() > 0 ||
                     std::any_of(kinds.begin(), kinds.end(), [](Kind kind) { return kind != Kind::central; });
  data_ = std::make_unique<Data>(layout_of(unknowns, turns, scale), bodies, empty_chunks(unknowns));
  EIGENGRAIN_ASSERT(size() == unknowns.size(), size(), unknowns.size());
  const Visits visits(unknowns, bodies, elements);
  data_->for_each_chunk([&](Chunk& chunk) {
    chunk.central = make_records<CentralRecord>(chunk, Kind::central, visits, elements, kinds, bodies);
    chunk.ball = make_records<BallRecord>(chunk, Kind::ball, visits, elements, kinds, bodies);
    chunk.general = make_records<GeneralRecord>(chunk, Kind::general, visits, elements, kinds, bodies);
  });
  data_->record_bytes = bytes_of(data_->chunks);
  data_->axes = own_axes(unknowns, data_->layout, data_->chunks);
  if (parts.nodal != nullptr) {
    data_->nodal = &parts.nodal->k;
    data_->record_bytes += static_cast<std::int64_t>(76 * parts.nodal->k.columns.size());
  }
}

StiffnessProduct::~StiffnessProduct() = default;
StiffnessProduct::StiffnessProduct(StiffnessProduct&&) noexcept = default;
StiffnessProduct& StiffnessProduct::operator=(StiffnessProduct&&) noexcept = default;

std::int64_t StiffnessProduct::size() const {
  return std::ssize(data_->layout.scale);
}
std::int64_t StiffnessProduct::record_bytes() const {
  return data_->record_bytes;
}
std::int64_t StiffnessProduct::products() const {
  return data_->products;
}

void StiffnessProduct::apply(std::span<const double> x, std::span<double> y) {
  Data& d = *data_;
  EIGENGRAIN_ASSERT(std::ssize(x) == size() && std::ssize(y) == size(), x.size(), y.size(), size());
  ++d.products;
  // All of x before any of y: a chunk reads the bodies of other chunks.
  d.for_each_numbered_chunk([&](std::int64_t c) {
    d.kernel->pad(d.layout, d.chunks[static_cast<std::size_t>(c)], x.data(), d.x.data());
    if (!d.axes.empty()) d.to_space(c);
  });
  d.for_each_numbered_chunk([&](std::int64_t c) {
    const Chunk& chunk = d.chunks[static_cast<std::size_t>(c)];
    const auto bodies = static_cast<std::size_t>(chunk.last_body - chunk.first_body);
    double* sums = zeroed_sums(static_cast<std::size_t>(d.layout.stride) * bodies);
    d.kernel->multiply(d.layout, chunk, d.x.data(), sums);
    if (!d.axes.empty()) d.to_own_axes(c, sums);
    d.kernel->strip(d.layout, chunk, sums, y.data());
  });
  if (d.nodal != nullptr) add_nodal(*d.nodal, d.layout.scale, x, y);
}

}  // namespace eigengrain::assembly
