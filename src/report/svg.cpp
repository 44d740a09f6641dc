#include "svg.hpp"

#include <fmt/format.h>

#include <cstddef>

namespace eigengrain::report {
namespace {

/// Bytes of the UTF-8 sequence that begins the text, 0 where none does.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80                     ? 1
                             : first >= 0xC2 && first < 0xE0  ? 2
                             : first >= 0xE0 && first < 0xF0  ? 3
                             : first >= 0xF0 && first <= 0xF4 ? 4
                                                              : 0;
  if (length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte(k) & 0xC0) != 0x80) return 0;
  // Too long for what they say, surrogates, beyond the last character.
  if (first == 0xE0 && byte(1) < 0xA0) return 0;
  if (first == 0xED && byte(1) >= 0xA0) return 0;
  if (first == 0xF0 && byte(1) < 0x90) return 0;
  if (first == 0xF4 && byte(1) >= 0x90) return 0;
  return length;
}

constexpr std::string_view replacement = "\xEF\xBF\xBD";

/// Widths in ems of a sans-serif face, DejaVu's, which is a wide one.
double character_width(char c) {
  constexpr std::string_view narrow = "iIjlft.,:;'|()[]! -/";
  constexpr std::string_view wide = "mwMW@%";
  if (narrow.find(c) != std::string_view::npos) return 0.4;
  if (wide.find(c) != std::string_view::npos) return 0.95;
  return (c >= 'A' && c <= 'Z') ? 0.72 : 0.63;
}

std::string number(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

std::string dashes(std::string_view dash) {
  return dash.empty() ? std::string() : fmt::format(" stroke-dasharray=\"{}\"", dash);
}

/// An attribute, or nothing where the value is what the whole picture has.
std::string unless(std::string_view usual, std::string_view name, std::string_view value) {
  return value == usual ? std::string() : fmt::format(" {}=\"{}\"", name, value);
}

constexpr double line_width_of_marks = 1.4;

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    const char c = text.front();
    if (length == 0 || (length == 1 && static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') ||
        c == '\x7F')
      result += replacement;
    else if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else if (c == '\'')
      result += "&#39;";
    else
      result += text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return result;
}

double text_width(std::string_view text, double size) {
  double ems = 0;
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    ems += length == 1 ? character_width(text.front()) : 0.7;
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return ems * size;
}

Svg::Svg(double width, double height, std::string_view title)
    : body_(
          fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
                      "height=\"{1}\" role=\"img\" font-family=\"sans-serif\" font-size=\"{2}\" fill=\"{3}\" "
                      "stroke-width=\"{4}\">\n<title>{5}</title>\n",
                      number(width), number(height), number(text_size), colour::ink, line_width_of_marks,
                      escaped(title))) {}

void Svg::lines(const std::vector<Line>& all, std::string_view colour, double width, std::string_view dash) {
  if (all.empty()) return;
  std::string path;
  for (const Line& line : all)
    path += fmt::format("M{} {}L{} {}", number(line.from.x), number(line.from.y), number(line.to.x),
                        number(line.to.y));
  body_ += fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n", path, colour, number(width),
                       dashes(dash));
}

void Svg::polyline(std::span<const Place> places, std::string_view colour, double width,
                   std::string_view dash) {
  if (places.size() < 2) return;
  std::string path;
  for (const Place& place : places)
    path += fmt::format("{}{} {}", path.empty() ? "M" : "L", number(place.x), number(place.y));
  body_ += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n", path, colour,
                       number(width), dashes(dash));
}

void Svg::rectangle(const Box& box, std::string_view fill, std::string_view edge) {
  body_ +=
      fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\" stroke=\"{}\"/>\n",
                  number(box.left), number(box.top), number(box.width()), number(box.height()), fill, edge);
}

void Svg::text(const Place& at, std::string_view text, Align align, double size, std::string_view colour,
               double turned) {
  const std::string_view anchor = align == Align::start ? "start" : align == Align::middle ? "middle" : "end";
  std::string attributes = unless(number(text_size), "font-size", number(size)) +
                           unless(colour::ink, "fill", colour) + unless("start", "text-anchor", anchor);
  if (turned != 0)
    attributes += fmt::format(" transform=\"rotate({} {} {})\"", number(turned), number(at.x), number(at.y));
  body_ += fmt::format("<text x=\"{}\" y=\"{}\"{}>{}</text>\n", number(at.x), number(at.y), attributes,
                       escaped(text));
}

void Svg::mark(const Place& at, const Look& look, double size) {
  const auto around = [&](double dx, double dy) {
    return fmt::format("{} {}", number(at.x + size * dx), number(at.y + size * dy));
  };
  const std::string paint = look.filled && look.mark != Mark::cross
                                ? unless(colour::ink, "fill", look.colour)
                                : fmt::format(" fill=\"#fff\" stroke=\"{}\"", look.colour);
  std::string path;
  switch (look.mark) {
    case Mark::circle:
      body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n", number(at.x), number(at.y),
                           number(1.15 * size), paint);
      return;
    case Mark::diamond:
      path =
          "M" + around(0, -1.5) + "L" + around(1.5, 0) + "L" + around(0, 1.5) + "L" + around(-1.5, 0) + "Z";
      break;
    case Mark::square:
      path = "M" + around(-1, -1) + "L" + around(1, -1) + "L" + around(1, 1) + "L" + around(-1, 1) + "Z";
      break;
    case Mark::triangle:
      path = "M" + around(0, -1.4) + "L" + around(1.35, 1.1) + "L" + around(-1.35, 1.1) + "Z";
      break;
    case Mark::cross:
      path = "M" + around(-1, -1) + "L" + around(1, 1) + "M" + around(-1, 1) + "L" + around(1, -1);
      break;
  }
  body_ += fmt::format("<path d=\"{}\"{}/>\n", path, paint);
}

}  // namespace eigengrain::report
