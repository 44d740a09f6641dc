#include "eigengrain/assembly/product.hpp"

#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/base/type_list.hpp"

#include "product_records.hpp"

#include <algorithm>
#include <cmath>
#include <new>

namespace eigengrain::assembly {
namespace product {

void kernel_baseline(const Chunk& chunk, int stride, const double* x, double* y);
#ifdef EIGENGRAIN_KERNEL_AVX2
void kernel_avx2(const Chunk& chunk, int stride, const double* x, double* y);
#endif

Kernel best_kernel() {
#ifdef EIGENGRAIN_KERNEL_AVX2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return kernel_avx2;
#endif
  return kernel_baseline;
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
using product::Rows;

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
ContactElement turned(const ContactElement& e) {
  return {e.b, e.a, -e.normal, e.lever_b, e.lever_a, e.stiffness};
}

void copy(const Vec3& from, double* to) {
  std::copy_n(from.data(), 3, to);
}

CentralRecord record(const ContactElement& e, std::int32_t other, TypeTag<CentralRecord>) {
  CentralRecord r{};
  copy(std::sqrt(e.stiffness.normal) * e.normal, r.scaled_normal);
  r.other = other;
  return r;
}

BallRecord record(const ContactElement& e, std::int32_t other, TypeTag<BallRecord>) {
  BallRecord r{};
  copy(e.normal, r.normal);
  r.shear = e.stiffness.shear;
  r.normal_excess = e.stiffness.normal - e.stiffness.shear;
  r.near = e.lever_a.dot(e.normal);
  r.far = -e.lever_b.dot(e.normal);
  r.other = other;
  return r;
}

GeneralRecord record(const ContactElement& e, std::int32_t other, TypeTag<GeneralRecord>) {
  GeneralRecord r{};
  copy(e.normal, r.normal);
  copy(e.lever_a, r.lever_near);
  copy(e.lever_b, r.lever_far);
  r.shear = e.stiffness.shear;
  r.normal_excess = e.stiffness.normal - e.stiffness.shear;
  r.bending = e.stiffness.bending;
  r.twist_excess = e.stiffness.twist - e.stiffness.bending;
  r.other = other;
  return r;
}

/// Bodies a chunk: some tens of chunks for threads to share, few contacts between them.
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
      visits_[static_cast<std::size_t>(next[static_cast<std::size_t>(body)]++)] = visit;
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

template <class Record>
Records<Record> make_records(const Chunk& chunk, Kind kind, const Visits& visits,
                             std::span<const ContactElement> elements, std::int32_t nobody) {
  Records<Record> result;
  Rows& rows = result.rows;
  rows.inner.push_back(0);
  rows.cut.push_back(0);
  for (std::int32_t body = chunk.first; body < chunk.last; ++body) {
    for (const Visit& visit : visits.of(body)) {
      const ContactElement& e = elements[static_cast<std::size_t>(visit.element)];
      if (kind_of(e) != kind) continue;
      const ContactElement seen = visit.swapped ? turned(e) : e;
      const std::int32_t other = seen.b == no_body ? nobody : seen.b;
      (visit.inner ? result.inner : result.cut).push_back(record(seen, other, TypeTag<Record>{}));
    }
    rows.inner.push_back(static_cast<std::int64_t>(result.inner.size()));
    rows.cut.push_back(static_cast<std::int64_t>(result.cut.size()));
  }
  // A kind that the chunk has none of costs nothing, not even its row offsets.
  if (result.inner.empty() && result.cut.empty()) rows = {};
  return result;
}

}  // namespace

struct StiffnessProduct::Data {
  Data(const Unknowns& unknowns, std::int32_t bodies, bool turns, std::vector<double> scaling)
      : stride(turns ? product::rotation_stride : product::translation_stride),
        scale(std::move(scaling)),
        // One body more than there are: the one at rest behind walls.
        x(static_cast<std::size_t>(stride) * (static_cast<std::size_t>(bodies) + 1)),
        y(x.size()) {
    slot.reserve(static_cast<std::size_t>(unknowns.blocks()));
    for (std::int32_t block = 0; block < unknowns.blocks(); ++block)
      slot.push_back(std::int64_t{stride} * unknowns.body(block) + (unknowns.is_rotation(block) ? 4 : 0));
  }

  int stride;
  std::vector<double> scale;
  std::vector<std::int64_t> slot;  ///< [blocks] where the block stands in the padded vectors
  PaddedVector x;
  PaddedVector y;
  std::vector<Chunk> chunks;
  product::Kernel kernel = product::best_kernel();
  std::int64_t record_bytes = 0;
  std::int64_t products = 0;
};

namespace {

std::vector<double> full_scaling(const Unknowns& unknowns, std::span<const double> scale) {
  if (!scale.empty()) return {scale.begin(), scale.end()};
  std::vector<double> ones(static_cast<std::size_t>(unknowns.size()), 0.0);
  for (const std::int32_t number : unknowns.free_components()) ones[static_cast<std::size_t>(number)] = 1.0;
  return ones;
}

}  // namespace

StiffnessProduct::StiffnessProduct(const Unknowns& unknowns, std::span<const ContactElement> elements,
                                   std::span<const double> scale) {
  const std::int32_t bodies = unknowns.bodies();
  // Contacts with shear read rotations even where every body holds its own.
  const bool turns = std::any_of(elements.begin(), elements.end(),
                                 [](const ContactElement& e) { return kind_of(e) != Kind::central; });
  data_ = std::make_unique<Data>(unknowns, bodies, turns, full_scaling(unknowns, scale));
  EIGENGRAIN_ASSERT(static_cast<std::int64_t>(data_->scale.size()) == unknowns.size(), data_->scale.size(),
                    unknowns.size());
  const Visits visits(unknowns, bodies, elements);
  const std::int32_t size = chunk_size(bodies);
  for (std::int32_t first = 0; first < bodies; first += size) {
    Chunk& chunk = data_->chunks.emplace_back();
    chunk.first = first;
    chunk.last = std::min(first + size, bodies);
  }
  for_chunks(static_cast<std::int64_t>(data_->chunks.size()), 1,
             [&](std::int64_t c, std::int64_t, std::int64_t) {
               Chunk& chunk = data_->chunks[static_cast<std::size_t>(c)];
               chunk.central = make_records<CentralRecord>(chunk, Kind::central, visits, elements, bodies);
               chunk.ball = make_records<BallRecord>(chunk, Kind::ball, visits, elements, bodies);
               chunk.general = make_records<GeneralRecord>(chunk, Kind::general, visits, elements, bodies);
             });
  const auto bytes = [](const auto& records) {
    return (records.inner.size() + records.cut.size()) * sizeof(records.inner[0]);
  };
  for (const Chunk& chunk : data_->chunks)
    data_->record_bytes +=
        static_cast<std::int64_t>(bytes(chunk.central) + bytes(chunk.ball) + bytes(chunk.general));
}

StiffnessProduct::~StiffnessProduct() = default;
StiffnessProduct::StiffnessProduct(StiffnessProduct&&) noexcept = default;
StiffnessProduct& StiffnessProduct::operator=(StiffnessProduct&&) noexcept = default;

std::int64_t StiffnessProduct::size() const {
  return static_cast<std::int64_t>(data_->scale.size());
}
std::int64_t StiffnessProduct::record_bytes() const {
  return data_->record_bytes;
}
std::int64_t StiffnessProduct::products() const {
  return data_->products;
}

void StiffnessProduct::apply(std::span<const double> x, std::span<double> y) {
  Data& d = *data_;
  EIGENGRAIN_ASSERT(x.size() == d.scale.size() && y.size() == d.scale.size(), x.size(), y.size(),
                    d.scale.size());
  ++d.products;
  double* padded_x = d.x.data();
  double* padded_y = d.y.data();
  const auto blocks = static_cast<std::int64_t>(d.slot.size());

  // x <- S x, padded
  for_chunks(blocks, 4096, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
    for (std::int64_t block = begin; block < end; ++block) {
      const auto from = static_cast<std::size_t>(3 * block);
      double* to = padded_x + d.slot[static_cast<std::size_t>(block)];
      for (std::size_t k = 0; k < 3; ++k) to[k] = d.scale[from + k] * x[from + k];
    }
  });
  // y <- K x, chunk by chunk
  for_chunks(static_cast<std::int64_t>(d.chunks.size()), 1, [&](std::int64_t c, std::int64_t, std::int64_t) {
    const Chunk& chunk = d.chunks[static_cast<std::size_t>(c)];
    std::fill(padded_y + std::int64_t{d.stride} * chunk.first, padded_y + std::int64_t{d.stride} * chunk.last,
              0.0);
    d.kernel(chunk, d.stride, padded_x, padded_y);
  });
  // y <- S y
  for_chunks(blocks, 4096, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
    for (std::int64_t block = begin; block < end; ++block) {
      const auto to = static_cast<std::size_t>(3 * block);
      const double* from = padded_y + d.slot[static_cast<std::size_t>(block)];
      for (std::size_t k = 0; k < 3; ++k) y[to + k] = d.scale[to + k] * from[k];
    }
  });
}

}  // namespace eigengrain::assembly
