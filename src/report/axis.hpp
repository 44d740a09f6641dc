#pragma once

#include <string>
#include <vector>

/// Axes of pictures: where a value stands, and which values are written beside the axis.
namespace eigengrain::report {

struct Tick {
  double value = 0;
  std::string label;  ///< empty: a small mark between two that are written
};

class Axis {
 public:
  /// From low to high, widened to round numbers.
  static Axis linear(double low, double high);
  /// Values above 0, in decades; widened to 1, 2 or 5 times a power of ten.
  static Axis logarithmic(double low, double high);
  /// The same with a little room at both ends instead.
  static Axis logarithmic_with_margins(double low, double high);
  /// A part of one that is too much (> 0) or too little (< 0): logarithmic both ways from 0, and linear up to
  /// `nearest` about it. Widened to powers of ten; of what is too little no more than -1 is possible. Labels
  /// are percent.
  static Axis signed_distance(double low, double high, double nearest);

  /// 0 at the low end, 1 at the high end; values beyond the ends are put on them, and so is what has no
  /// place.
  double place(double value) const;
  const std::vector<Tick>& ticks() const { return ticks_; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  enum class Kind { linear, logarithmic, signed_distance };
  Axis(Kind kind, double low, double high, double nearest = 0);
  double stretched(double value) const;

  Kind kind_;
  double low_;
  double high_;
  double nearest_;
  std::vector<Tick> ticks_;
};

/// A number as one writes it: 0.05, 12, 1.5×10⁻⁷. Three digits at most.
std::string number_text(double value);
/// 10⁻⁶ with raised digits.
std::string power_of_ten(int exponent);

}  // namespace eigengrain::report
