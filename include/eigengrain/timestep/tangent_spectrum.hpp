#pragma once

#include "eigengrain/assembly/model.hpp"

#include <complex>
#include <cstdint>
#include <limits>

/// What the elastic stiffness leaves out, as eigenvalues of M⁻¹T, T the exact derivative of the contact
/// forces.
namespace eigengrain::timestep {

/// An eigenvalue of an unsymmetric matrix, one of a pair where it is complex (imaginary part >= 0), s⁻².
struct Eigenvalue {
  std::complex<double> value = std::numeric_limits<double>::quiet_NaN();
  double residual = 0;  ///< |A x - λ x| / (|λ| |x|), or over the largest |λ| where that is dense

  bool found() const { return value == value; }
};

/// Ends of a spectrum. What did not converge is not found().
struct SpectrumEnds {
  Eigenvalue largest;  ///< the largest real part: of the elastic K it is λ_max
  Eigenvalue least;    ///< the least real part: negative where present forces make something buckle
};

struct TangentSpectrum {
  std::int64_t contacts = 0;  ///< acting
  std::int64_t sliding = 0;   ///< at the limit of friction
  SpectrumEnds elastic;       ///< of K; large systems have no least one, which is not negative
  SpectrumEnds sticking;      ///< of T, all contacts sticking: K and what present forces add as contacts turn
  SpectrumEnds slipping;      ///< of T, contacts at the limit of friction slipping on; unsymmetric
  Eigenvalue widest;          ///< of that, the one with the largest imaginary part
  std::int64_t complex_pairs = 0;  ///< of that; -1 where the system is too large to have all of them
  double seconds = 0;
};

/// Systems up to this size have all their eigenvalues computed (dense); larger ones have the ends
/// (Krylov-Schur).
inline constexpr std::int64_t dense_tangent_unknowns = 300;

/// Of a model as it stands, undamped. Masses scaled are scaled here.
TangentSpectrum tangent_spectrum(const assembly::Model& model);

/// |z| of the faster root of z + 1/z = 2 - λΔt²: by how much a mode of this λ grows in a step of the undamped
/// cycle. 1 for real λ between 0 and 4/Δt²; more than 1 at any step where λ is complex (flutter) or negative
/// (buckling).
double growth_per_step(std::complex<double> lambda, double dt);

}  // namespace eigengrain::timestep
