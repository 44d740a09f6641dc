#pragma once

#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

/// What is known of each scene of examples/scenes/hard_cases. A scene that stands there and not here fails.
namespace eigengrain::test {

/// The default, a safety of 0.8 times the diagonal estimate.
enum class Default { safe, above_the_limit };

struct Expectation {
  std::string_view scene;
  double critical = 0;  ///< 2/√λ_max in closed form, s; 0: none, the dense spectrum is the reference
  double error = 0;     ///< relative, of the closed form: what overlaps and rounded input change
  double diagonal = 0;  ///< the diagonal estimate over the truth, to 1e-4
  Default standard = Default::safe;
  bool linear = true;
  double cycle = 1;  ///< the limit of the cycle by running over that of K
  /// By how much runs may differ from that. The bracket that they end with is 1e-4 wide, and growth by less
  /// than some 1e-4 above the limit is not seen with dashpots (timestep/empirical_limit.hpp).
  double by_running = 2e-4;
};

/// Scenes whose first moment has no contact to ask about: tests of runs have them.
inline const std::vector<std::string_view>& without_contacts_at_first() {
  static const std::vector<std::string_view> scenes{"ten_contacts_at_once"};
  return scenes;
}

inline const std::vector<Expectation>& expectations() {
  using std::sqrt;
  const double oblique = sqrt(1.5);   // √3 √(m/k) over √2 √(m/k)
  const double half = 1 / sqrt(2.0);  // one degree of freedom alone has half of λ_max
  const double fixed_chain = 1 / std::sin(6 * std::numbers::pi / 14);
  // The larger root of (2 - x)(1e-6 - x) = 1e-6, in k_n/m_2.
  const double pinned = 0.5 * (2 + 1e-6 + sqrt((2 - 1e-6) * (2 - 1e-6) + 4e-6));
  static const std::vector<Expectation> all{
      {.scene = "oblique_pair", .critical = sqrt(2.0), .error = 1e-9, .diagonal = oblique},
      {.scene = "oblique_chain", .critical = 1, .error = 1e-9, .diagonal = oblique},
      {.scene = "stiffness_contrast", .critical = 2 / sqrt(2e6 + 1), .error = 1e-9, .diagonal = oblique},
      {.scene = "size_ratio_10", .critical = 2 / sqrt(2002.0), .error = 1e-9, .diagonal = 0.8665},
      {.scene = "size_ratio_100",
       .critical = 2e-3 / sqrt(pinned),
       .error = 1e-9,
       .diagonal = sqrt(1.5) / sqrt(2.0)},
      {.scene = "root_three_clumps",
       .critical = 1,
       .error = 1e-9,
       .diagonal = sqrt(3.0),
       .standard = Default::above_the_limit},
      {.scene = "bonded_beam", .critical = 2 / sqrt(10.0), .error = 1e-9, .diagonal = 0.8575},
      // The rule with dashpots over the undamped truth; the limit is damped too.
      {.scene = "overdamped_lattice",
       .critical = half,
       .error = 1e-9,
       .diagonal = half * (sqrt(5.0) - 2),
       .standard = Default::above_the_limit},
      {.scene = "mass_scaled_mixture", .critical = 1.25, .error = 1e-9, .diagonal = oblique},
      {.scene = "prestressed_column",
       .critical = fixed_chain,
       .error = 1e-9,
       .diagonal = half / fixed_chain,
       .linear = false},
      {.scene = "taut_chain",
       .critical = fixed_chain,
       .error = 1e-9,
       .diagonal = half / fixed_chain,
       .linear = false,
       .cycle = 1 / sqrt(1 + 0.2 / 2.2)},
      {.scene = "edge_of_rigidity", .diagonal = 0.6125, .linear = false},
      {.scene = "rotating_drum", .diagonal = 0.6392, .linear = false},
      {.scene = "tumbling_cluster", .diagonal = 0.6771},
      // Beside the bonds balls just touch: these springs are there in one half of a cycle only.
      {.scene = "breaking_bonds", .diagonal = 0.5923, .linear = false, .by_running = 1e-3},
      {.scene = "lattice_chain", .critical = 2 / sqrt(5.0), .error = 1e-9, .diagonal = half},
      {.scene = "lattice_square", .critical = 2 / sqrt(10.0), .error = 1e-9, .diagonal = half},
      {.scene = "lattice_hexagonal", .critical = 2 / sqrt(15.0), .error = 1e-9, .diagonal = half},
      {.scene = "lattice_hexagonal_disks", .critical = 2 / sqrt(12.0), .error = 1e-9, .diagonal = half},
      {.scene = "lattice_sc", .critical = 2 / sqrt(10.0), .error = 1e-9, .diagonal = half},
      {.scene = "lattice_bcc", .critical = 2 / sqrt(40.0 / 3), .error = 1e-9, .diagonal = half},
      {.scene = "lattice_fcc", .critical = 2 / sqrt(20.0), .error = 1e-9, .diagonal = half},
      {.scene = "lattice_diamond", .critical = 2 / sqrt(20.0 / 3), .error = 1e-9, .diagonal = half},
  };
  return all;
}

}  // namespace eigengrain::test
