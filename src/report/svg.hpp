#pragma once

#include "geometry.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Pictures as SVG that stands in an HTML page.
namespace eigengrain::report {

/// Text for XML and HTML, in elements and attributes: markup escaped, control characters and what is no UTF-8
/// replaced by U+FFFD.
std::string escaped(std::string_view text);

/// About how wide a text is in a sans-serif face, on the wide side.
double text_width(std::string_view text, double size);

/// Kinds that differ in shape, so that they can be told apart without colour.
enum class Mark { circle, diamond, square, triangle, cross };

/// Okabe and Ito's colours, which the colour-blind can tell apart, as far as they are dark enough on white.
namespace colour {
inline constexpr std::string_view ink = "#222222";
inline constexpr std::string_view faint = "#d9d9d9";
inline constexpr std::string_view grey = "#767676";
inline constexpr std::string_view blue = "#0072B2";
inline constexpr std::string_view green = "#009E73";
inline constexpr std::string_view vermilion = "#D55E00";
inline constexpr std::string_view purple = "#AA4499";
}  // namespace colour

struct Look {
  Mark mark = Mark::circle;
  std::string_view colour = colour::ink;
  bool filled = true;
};

enum class Align { start, middle, end };

inline constexpr double text_size = 11;

class Svg {
 public:
  /// title  what the picture shows, for those who cannot see it
  Svg(double width, double height, std::string_view title);

  void line(const Place& a, const Place& b, std::string_view colour, double width = 1,
            std::string_view dash = {}) {
    lines({{a, b}}, colour, width, dash);
  }
  /// Many lines of one look, as one element.
  void lines(const std::vector<Line>& all, std::string_view colour, double width = 1,
             std::string_view dash = {});
  void polyline(std::span<const Place> places, std::string_view colour, double width = 1.2,
                std::string_view dash = {});
  void rectangle(const Box& box, std::string_view fill, std::string_view edge = "none");
  void text(const Place& at, std::string_view text, Align align = Align::start, double size = text_size,
            std::string_view colour = colour::ink, double turned = 0);
  void mark(const Place& at, const Look& look, double size = 4);

  std::string finish() const { return body_ + "</svg>\n"; }

 private:
  std::string body_;
};

}  // namespace eigengrain::report
