#include "eigengrain/spectrum/rigidity.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/stiffness.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/measures/acting_contacts.hpp"
#include "eigengrain/petsc/session.hpp"

#include "sparse_qr.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <type_traits>
#include <utility>

namespace eigengrain::spectrum {
namespace {

using assembly::Model;
using assembly::Unknowns;
using contact::ContactElement;
using contact::no_body;

/// Singular values below this part of the norm are zeros.
constexpr double zero_part = 1e-10;

std::int32_t least_contacts(const Model& model, Springs springs) {
  if (springs != Springs::normal) return measures::least_contacts(model);
  const auto flat = [&](int axis) {
    return std::ranges::all_of(model.bodies.fixed, [&](const auto& f) { return f.component(axis); });
  };
  const std::int32_t dimensions = flat(0) || flat(1) || flat(2) ? 2 : 3;
  return model.gravity.isZero(0) ? dimensions + 1 : dimensions;
}

/// A bond beside the contact of a pair acts on the same δ and φ, with k_n = k^n + k̄^n A (eq. 1.34): one
/// element for both.
std::vector<ContactElement> merged(const std::vector<ContactElement>& elements) {
  std::vector<std::size_t> order(elements.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t i, std::size_t j) {
    return std::pair(elements[i].a, elements[i].b) < std::pair(elements[j].a, elements[j].b);
  });
  std::vector<ContactElement> result;
  for (const std::size_t k : order) {
    const ContactElement& e = elements[k];
    // Of two images of a pair the levers differ by about a radius.
    const auto same = [&](const ContactElement& other) {
      return other.a == e.a && other.b == e.b &&
             (other.lever_a - e.lever_a).norm() <= 1e-6 * e.lever_a.norm() &&
             (other.lever_b - e.lever_b).norm() <= 1e-6 * e.lever_b.norm();
    };
    const auto pair = std::ranges::find_if(result.rbegin(), result.rend(), [&](const ContactElement& other) {
      return other.a != e.a || other.b != e.b || same(other);
    });
    if (pair == result.rend() || !same(*pair)) {
      result.push_back(e);
      continue;
    }
    pair->stiffness = {.normal = pair->stiffness.normal + e.stiffness.normal,
                       .shear = pair->stiffness.shear + e.stiffness.shear,
                       .twist = pair->stiffness.twist + e.stiffness.twist,
                       .bending = pair->stiffness.bending + e.stiffness.bending};
  }
  return result;
}

/// The contacts that count, with the springs that count.
std::vector<ContactElement> counted_elements(const Model& model, const RigidityOptions& options,
                                             Rigidity& result) {
  if (!model.solids.empty())
    throw InputError(
        "rigidity counts contacts, and the scene has deformable bodies; leave them out, or ask for modes");
  const std::vector<measures::ActingContact> acting = measures::acting_contacts(model);
  const std::vector<bool> rattler = measures::rattlers(model, acting, least_contacts(model, options.springs));
  for (std::int32_t row = 0; row < model.bodies.size(); ++row)
    if (rattler[row] && model.bodies.clumps.owner(row) == row) ++result.rattlers;
  std::vector<ContactElement> elements;
  std::size_t contact = 0;  // of `acting`, which has no rows of their own for bonds beside a law
  assembly::for_each_element(model, assembly::Listed::acting, [&](const auto& law, ContactElement element) {
    bool slides = false;
    if constexpr (!contact::is_beside_law<std::decay_t<decltype(law)>>) slides = acting[contact++].slides;
    if (!options.with_rattlers && (rattler[element.a] || (element.b != no_body && rattler[element.b])))
      return;
    contact::ContactStiffness& k = element.stiffness;
    if (options.springs == Springs::normal)
      k = {.normal = k.normal};
    else if (options.springs == Springs::sticking && slides)
      k.shear = 0;
    if (k.normal > 0 || k.shear > 0 || k.twist > 0 || k.bending > 0) elements.push_back(element);
  });
  return merged(elements);
}

/// Two unit vectors across n.
std::pair<Vec3, Vec3> across(const Vec3& n) {
  const Vec3 first = n.unitOrthogonal();
  return {first, n.cross(first)};
}

/// √D B M^-½ on the free components, as entries, with its springs.
class SpringMatrix {
 public:
  SpringMatrix(const model::Bodies& bodies, std::span<const ContactElement> elements,
               const Unknowns& unknowns, std::vector<Spring>& springs)
      : bodies_(bodies),
        unknowns_(unknowns),
        springs_(springs),
        column_(static_cast<std::size_t>(unknowns.size()), -1) {
    const std::vector<std::int32_t> free = unknowns.free_components();
    for (std::size_t k = 0; k < free.size(); ++k) column_[free[k]] = static_cast<std::int32_t>(k);
    columns_ = static_cast<std::int64_t>(free.size());
    for (const ContactElement& e : elements) {
      const auto [t1, t2] = across(e.normal);
      add(e, SpringKind::normal, e.stiffness.normal, e.normal);
      add(e, SpringKind::shear, e.stiffness.shear, t1);
      add(e, SpringKind::shear, e.stiffness.shear, t2);
      add(e, SpringKind::twist, e.stiffness.twist, e.normal);
      add(e, SpringKind::bending, e.stiffness.bending, t1);
      add(e, SpringKind::bending, e.stiffness.bending, t2);
    }
  }
  std::int64_t columns() const { return columns_; }
  const std::vector<Entry>& entries() const { return entries_; }
  double root_of_mass(std::int32_t block, int k) const {
    const std::int32_t body = unknowns_.body(block);
    if (!unknowns_.is_rotation(block)) return std::sqrt(bodies_.mass[body]);
    if (unknowns_.axes(body) != nullptr) return std::sqrt(bodies_.clumps.inertia[bodies_.clumps.of(body)][k]);
    return std::sqrt(bodies_.inertia[body]);
  }

 private:
  void add(const ContactElement& e, SpringKind kind, double stiffness, const Vec3& direction) {
    if (!(stiffness > 0)) return;
    const bool turns = kind == SpringKind::twist || kind == SpringKind::bending;
    const double root = std::sqrt(stiffness);
    const auto row = static_cast<std::int64_t>(springs_.size());
    springs_.push_back({.a = e.a, .b = e.b, .kind = kind, .direction = direction});
    const auto add_end = [&](std::int32_t body, double sign, const Vec3& lever) {
      if (body == no_body) return;
      const auto [u, theta] = unknowns_.of(body);
      if (u != Unknowns::none && !turns) put(row, u, sign * root * direction);
      if (theta == Unknowns::none) return;
      Vec3 part = sign * root * (turns ? direction : Vec3(lever.cross(direction)));
      if (const Mat3* axes = unknowns_.axes(body)) part = axes->transpose() * part;
      put(row, theta, part);
    };
    add_end(e.a, -1, e.lever_a);
    add_end(e.b, 1, e.lever_b);
  }
  void put(std::int64_t row, std::int32_t block, const Vec3& value) {
    for (int k = 0; k < Unknowns::block_size; ++k) {
      const std::int32_t column = column_[static_cast<std::size_t>(Unknowns::block_size * block + k)];
      if (column >= 0) entries_.push_back({row, column, value[k] / root_of_mass(block, k)});
    }
  }

  const model::Bodies& bodies_;
  const Unknowns& unknowns_;
  std::vector<Spring>& springs_;
  std::vector<std::int32_t> column_;
  std::int64_t columns_ = 0;
  std::vector<Entry> entries_;
};

/// Rigid motions of everything together that neither springs nor fixed components resist.
std::int64_t count_trivial(const model::Bodies& bodies, const Unknowns& unknowns, const SpringMatrix& matrix,
                           std::int64_t rows, double norm) {
  Vec3 middle = Vec3::Zero();
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block)
    middle += model::centre_of(bodies, unknowns.body(block)) / unknowns.blocks();
  Eigen::MatrixXd motions(unknowns.size(), 6);
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block) {
    const std::int32_t body = unknowns.body(block);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 unit = Vec3::Unit(axis);
      Vec3 moved = Vec3::Zero();
      Vec3 turned = unit.cross(model::centre_of(bodies, body) - middle);
      if (unknowns.is_rotation(block))
        turned = unknowns.axes(body) != nullptr ? Vec3(unknowns.axes(body)->transpose() * unit) : unit;
      else
        moved = unit;
      for (int k = 0; k < 3; ++k) {
        const double root = matrix.root_of_mass(block, k);
        motions(3 * block + k, axis) = root * moved[k];
        motions(3 * block + k, 3 + axis) = root * turned[k];
      }
    }
  }
  // Those that are different motions, orthogonal; metres and radians have the same weight.
  for (Eigen::Index k = 0; k < motions.cols(); ++k)
    if (const double length = motions.col(k).norm(); length > 0) motions.col(k) /= length;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(motions);
  qr.setThreshold(1e-9);
  const Eigen::MatrixXd basis =
      Eigen::MatrixXd(qr.householderQ() * Eigen::MatrixXd::Identity(unknowns.size(), qr.rank()));
  // What springs and fixed components make of them, one below the other.
  Eigen::MatrixXd resisted = Eigen::MatrixXd::Zero(rows + basis.rows(), basis.cols());
  const std::vector<std::int32_t> free = unknowns.free_components();
  for (const Entry& e : matrix.entries()) resisted.row(e.row) += e.value / norm * basis.row(free[e.column]);
  resisted.bottomRows(basis.rows()) = basis;
  for (const std::int32_t number : free) resisted.row(rows + number).setZero();
  const Eigen::JacobiSVD<Eigen::MatrixXd> of(resisted);
  return std::ranges::count_if(of.singularValues(), [](double value) { return value < zero_part; });
}

}  // namespace

Rigidity rigidity(const Model& model, const RigidityOptions& options) {
  const Stopwatch watch;
  Rigidity result;
  const std::vector<ContactElement> elements = counted_elements(model, options, result);
  const Unknowns unknowns(model.bodies, elements);
  const SpringMatrix matrix(model.bodies, elements, unknowns, result.springs);
  std::vector<bool> moves(static_cast<std::size_t>(unknowns.bodies()), false);
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block) moves[unknowns.body(block)] = true;
  result.bodies = std::ranges::count(moves, true);
  result.set_aside = std::ssize(unknowns.set_aside());
  result.contacts = std::ssize(elements);
  result.unknowns = matrix.columns();
  const auto rows = static_cast<std::int64_t>(result.springs.size());
  if (rows == 0 || result.unknowns == 0) {
    result.floppy = result.unknowns;
    result.self_stress = rows;
    return result;
  }
  petsc::start();  // holds BLAS to one thread
  SparseQr session;
  const double norm = largest_row_and_column(matrix.entries(), rows, result.unknowns);
  const double tolerance = zero_part * norm;
  result.trivial = count_trivial(model.bodies, unknowns, matrix, rows, norm);

  // The null space of S is what the columns of Q beyond the rank of Sᵀ = Q R span; that of Sᵀ likewise from S
  // = Q R.
  const QrResult of_transpose =
      session.decompose(matrix.entries(), rows, result.unknowns, true, tolerance, options.shapes);
  const QrResult of_matrix =
      session.decompose(matrix.entries(), rows, result.unknowns, false, tolerance, options.shapes);
  result.floppy = result.unknowns - of_transpose.rank;
  result.self_stress = rows - of_matrix.rank;
  if (options.shapes) {
    result.floppy_residual = largest_image(matrix.entries(), rows, of_transpose.null_space, false) / norm;
    result.stress_residual =
        largest_image(matrix.entries(), result.unknowns, of_matrix.null_space, true) / norm;
    const std::vector<std::int32_t> free = unknowns.free_components();
    for (Eigen::Index k = 0; k < of_transpose.null_space.cols(); ++k) {
      std::vector<double> u(static_cast<std::size_t>(3 * unknowns.bodies()), 0.0);
      std::vector<double> theta = u;
      for (std::size_t i = 0; i < free.size(); ++i) {
        const std::int32_t block = free[i] / Unknowns::block_size;
        const int component = free[i] % Unknowns::block_size;
        const double value =
            of_transpose.null_space(static_cast<Eigen::Index>(i), k) / matrix.root_of_mass(block, component);
        const std::int32_t body = unknowns.body(block);
        if (!unknowns.is_rotation(block)) {
          u[static_cast<std::size_t>(3 * body + component)] = value;
          continue;
        }
        const Mat3* axes = unknowns.axes(body);
        for (int j = 0; j < 3; ++j)
          theta[static_cast<std::size_t>(3 * body + j)] +=
              axes != nullptr ? (*axes)(j, component) * value : (j == component ? value : 0.0);
      }
      result.floppy_u.push_back(std::move(u));
      result.floppy_theta.push_back(std::move(theta));
    }
    for (Eigen::Index k = 0; k < of_matrix.null_space.cols(); ++k) {
      const Eigen::VectorXd stress = of_matrix.null_space.col(k);
      result.stress.emplace_back(stress.begin(), stress.end());
    }
  }
  result.seconds = watch.seconds();
  return result;
}

}  // namespace eigengrain::spectrum
