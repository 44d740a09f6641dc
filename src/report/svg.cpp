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
    : body_(fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
                        "height=\"{1}\" role=\"img\" font-family=\"sans-serif\">\n<title>{2}</title>\n",
                        number(width), number(height), escaped(title))) {}

void Svg::line(const Place& a, const Place& b, std::string_view colour, double width, std::string_view dash) {
  body_ += fmt::format("<path d=\"M{} {}L{} {}\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n", number(a.x),
                       number(a.y), number(b.x), number(b.y), colour, number(width), dashes(dash));
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
  const std::string_view anchor = align == Align::start ? "" : align == Align::middle ? "middle" : "end";
  body_ += fmt::format(
      "<text x=\"{}\" y=\"{}\" font-size=\"{}\" fill=\"{}\"{}{}>{}</text>\n", number(at.x), number(at.y),
      number(size), colour, anchor.empty() ? std::string() : fmt::format(" text-anchor=\"{}\"", anchor),
      turned == 0
          ? std::string()
          : fmt::format(" transform=\"rotate({} {} {})\"", number(turned), number(at.x), number(at.y)),
      escaped(text));
}

void Svg::mark(const Place& at, const Look& look, double size) {
  std::string path;
  const auto around = [&](double dx, double dy) {
    return fmt::format("{} {}", number(at.x + dx), number(at.y + dy));
  };
  const double s = size;
  switch (look.mark) {
    case Mark::circle:
      body_ += fmt::format(
          "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.4\"/>\n",
          number(at.x), number(at.y), number(s), look.filled ? look.colour : "white", look.colour);
      return;
    case Mark::diamond:
      path = "M" + around(0, -1.3 * s) + "L" + around(1.3 * s, 0) + "L" + around(0, 1.3 * s) + "L" +
             around(-1.3 * s, 0) + "Z";
      break;
    case Mark::square:
      path = "M" + around(-s, -s) + "L" + around(s, -s) + "L" + around(s, s) + "L" + around(-s, s) + "Z";
      break;
    case Mark::triangle:
      path = "M" + around(0, -1.3 * s) + "L" + around(1.2 * s, s) + "L" + around(-1.2 * s, s) + "Z";
      break;
    case Mark::cross:
      path = "M" + around(-s, -s) + "L" + around(s, s) + "M" + around(-s, s) + "L" + around(s, -s);
      break;
  }
  body_ += fmt::format("<path d=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.4\"/>\n", path,
                       look.filled && look.mark != Mark::cross ? look.colour : "white", look.colour);
}

}  // namespace eigengrain::report
