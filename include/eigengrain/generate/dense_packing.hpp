#pragma once

#include "eigengrain/generate/balls.hpp"
#include "eigengrain/generate/random.hpp"
#include "eigengrain/generate/region.hpp"

#include <cstdint>
#include <vector>

/// Dense random packings of frictionless balls: random places, then the energy of the overlaps, Σ δ²/2 over
/// contacts of balls and with the open faces of the region, is minimised by FIRE (Bitzek et al., Phys. Rev.
/// Lett. 97, 170201, 2006). Where the balls have room that ends without overlaps; beyond the jamming fraction
/// (O'Hern et al., Phys. Rev. E 68, 011306, 2003; about 0.64 for equal balls) in an equilibrium with them.
///
/// Overlaps are given relative: δ/(r_a + r_b) of two balls, δ/r with a face (as with the mirror image behind
/// it).
namespace eigengrain::generate {

struct DensePacking {
  Balls balls;                 ///< sorted in space, not in the order of the radii given
  double fraction = 0;         ///< solid_fraction
  double largest_overlap = 0;  ///< relative; 0 where nothing overlaps
  double mean_overlap = 0;     ///< relative, over contacts
  double coordination = 0;     ///< contacts a ball, faces included
  double scale = 1;            ///< of the radii given
  std::int64_t iterations = 0;
  bool at_rest = true;  ///< nothing overlaps, or forces balance to 1e-6 of the mean force in a contact
};

/// Packs balls of the radii given (m), that is, to the fraction that they make of the region.
///
/// Cost: some hundred to some thousand iterations of O(n), most near jamming. The result depends on the seed
/// only, not on the number of threads. Throws InputError where a ball is too large for the region, and where
/// the balls are so many that they overlap by more than a tenth.
DensePacking pack_densely(std::vector<double> radii, const Region& region, Random& random);

/// Packs balls whose radii are all multiplied by one factor, such that the mean overlap in equilibrium is the
/// one given, to 1%. It measures pressure: linear springs k of length l make p = Σ k δ l/(3 V).
///
/// Throws InputError as pack_densely does, and where no equilibrium with that overlap is found.
DensePacking pack_to_overlap(std::vector<double> radii, const Region& region, double mean_overlap,
                             Random& random);

}  // namespace eigengrain::generate
