#include "axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace eigengrain::report {
namespace {

constexpr int most_labels = 7;
constexpr double rounding = 1e-9;

double decade(int exponent) {
  return std::pow(10.0, exponent);
}

/// Widest of 1, 2 or 5 times a power of ten that divides a length into at least four parts.
double round_step(double length) {
  const double rough = length / 4;
  const double base = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {5.0, 2.0})
    if (factor * base <= rough * (1 + rounding)) return factor * base;
  return base;
}

/// The largest of 1, 2, 5 times a power of ten that is no more than the value; upwards: the smallest no less.
double round_in_decades(double value, bool upwards) {
  const int exponent = static_cast<int>(std::floor(std::log10(value) + rounding));
  std::array<double, 4> round{1, 2, 5, 10};
  if (upwards) {
    for (const double factor : round)
      if (factor * decade(exponent) >= value * (1 - rounding)) return factor * decade(exponent);
    return decade(exponent + 1);
  }
  std::reverse(round.begin(), round.end());
  for (const double factor : round)
    if (factor * decade(exponent) <= value * (1 + rounding)) return factor * decade(exponent);
  return decade(exponent);
}

std::vector<Tick> linear_ticks(double low, double high, double step) {
  std::vector<Tick> ticks;
  for (double k = std::round(low / step); k <= high / step + rounding; ++k)
    ticks.push_back({k * step, number_text(k * step)});
  return ticks;
}

std::vector<Tick> logarithmic_ticks(double low, double high) {
  const int first = static_cast<int>(std::floor(std::log10(low) + rounding));
  const int last = static_cast<int>(std::floor(std::log10(high) + rounding));
  const double decades = std::log10(high / low);
  const int every = static_cast<int>(std::ceil(decades / most_labels));
  std::vector<Tick> ticks;
  for (int exponent = first; exponent <= last; ++exponent)
    for (int digit = 1; digit <= 9; ++digit) {
      const double value = digit * decade(exponent);
      if (value < low * (1 - rounding) || value > high * (1 + rounding)) continue;
      const bool written = digit == 1       ? exponent % every == 0
                           : decades <= 1.1 ? digit == 2 || digit == 3 || digit == 5 || digit == 7
                           : decades <= 2.5 ? digit == 2 || digit == 5
                                            : false;
      if (digit > 1 && every > 1) continue;
      ticks.push_back({value, written ? number_text(value) : std::string()});
    }
  return ticks;
}

std::string percent(double part) {
  return fmt::format("{}{}%", part > 0 ? "+" : "−", number_text(100 * std::abs(part)));
}

std::vector<Tick> signed_ticks(double low, double high, double nearest) {
  std::vector<Tick> ticks{{0, "0"}};
  for (double size = nearest; size <= std::max(-low, high) * (1 + rounding); size *= 10)
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * size;
      const bool written = digit == 1;
      if (value <= high * (1 + rounding)) ticks.push_back({value, written ? percent(value) : std::string()});
      if (value <= -low * (1 + rounding))
        ticks.push_back({-value, written ? percent(-value) : std::string()});
    }
  std::sort(ticks.begin(), ticks.end(), [](const Tick& a, const Tick& b) { return a.value < b.value; });
  return ticks;
}

}  // namespace

Axis::Axis(Kind kind, double low, double high, double nearest)
    : kind_(kind), low_(low), high_(high), nearest_(nearest) {}

Axis Axis::linear(double low, double high) {
  if (!(high > low)) high = low + std::max(std::abs(low), 1.0);
  const double step = round_step(high - low);
  Axis axis(Kind::linear, step * std::floor(low / step + rounding), step * std::ceil(high / step - rounding));
  axis.ticks_ = linear_ticks(axis.low_, axis.high_, step);
  return axis;
}

Axis Axis::logarithmic(double low, double high) {
  if (!(low > 0) || !std::isfinite(low)) low = high > 0 && std::isfinite(high) ? high / 10 : 0.1;
  if (!(high > low)) std::tie(low, high) = std::pair(low / 2, low * 2);
  Axis axis(Kind::logarithmic, round_in_decades(low, false), round_in_decades(high, true));
  axis.ticks_ = logarithmic_ticks(axis.low_, axis.high_);
  return axis;
}

Axis Axis::logarithmic_with_margins(double low, double high) {
  const double margin = std::pow(high / low, 0.03);
  if (!(low > 0) || !(margin > 1) || !std::isfinite(margin)) return logarithmic(low, high);
  Axis axis(Kind::logarithmic, low / margin, high * margin);
  axis.ticks_ = logarithmic_ticks(axis.low_, axis.high_);
  return axis;
}

Axis Axis::signed_distance(double low, double high, double nearest) {
  const auto widened = [&](double size) {
    return std::max(nearest, decade(static_cast<int>(std::ceil(std::log10(size) - rounding))));
  };
  const double below = low < 0 ? -std::min(1.0, widened(-low)) : -nearest;
  const double above = high > 0 ? round_in_decades(std::max(high, nearest), true) : nearest;
  Axis axis(Kind::signed_distance, below, above, nearest);
  axis.ticks_ = signed_ticks(below, above, nearest);
  return axis;
}

double Axis::stretched(double value) const {
  switch (kind_) {
    case Kind::logarithmic:
      return std::log10(value);
    case Kind::signed_distance: {
      const double size = std::abs(value) / nearest_;
      return std::copysign(size <= 1 ? 0.7 * size : 0.7 + std::log10(size), value);
    }
    case Kind::linear:
      break;
  }
  return value;
}

double Axis::place(double value) const {
  const double start = stretched(low_);
  const double part = (stretched(value) - start) / (stretched(high_) - start);
  return part >= 0 ? std::min(part, 1.0) : 0.0;  // NaN is put on the low end
}

std::string power_of_ten(int exponent) {
  constexpr std::array<std::string_view, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "10";
  if (exponent < 0) text += "⁻";
  for (const char digit : std::to_string(std::abs(exponent)))
    text += raised[static_cast<std::size_t>(digit - '0')];
  return text;
}

std::string number_text(double value) {
  if (value == 0) return "0";
  if (!std::isfinite(value)) return value > 0 ? "∞" : (value < 0 ? "−∞" : "–");
  const std::string scientific = fmt::format("{:.2e}", std::abs(value));
  const std::size_t e = scientific.find('e');
  const int exponent = std::stoi(scientific.substr(e + 1));
  const std::string sign = value < 0 ? "−" : "";
  if (exponent >= -4 && exponent < 5) {
    // Three digits, none behind the point that the value has not.
    std::string plain = fmt::format("{:.{}f}", std::stod(scientific), std::max(0, 2 - exponent));
    if (plain.find('.') != std::string::npos) {
      plain.erase(plain.find_last_not_of('0') + 1);
      if (plain.back() == '.') plain.pop_back();
    }
    return sign + plain;
  }
  std::string digits = scientific.substr(0, e);
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return sign + (digits == "1" ? power_of_ten(exponent) : digits + "×" + power_of_ten(exponent));
}

}  // namespace eigengrain::report
