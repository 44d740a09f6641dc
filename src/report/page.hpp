#pragma once

#include <string>
#include <string_view>
#include <vector>

/// One HTML file that needs nothing beside itself: no scripts, no fonts, no pictures from elsewhere.
namespace eigengrain::report {

/// What a cell of a table says beside its text.
enum class Emphasis { none, faint, good, bad };

struct Cell {
  std::string text;
  Emphasis emphasis = Emphasis::none;
};

struct Table {
  struct Column {
    std::string name;
    bool number = false;   ///< set to the right
    bool upright = false;  ///< the name stands on end, for narrow columns
  };
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
};

/// All texts are plain; markup in them is escaped. Only pictures are taken as they are.
class Page {
 public:
  Page(std::string_view title, std::string_view subtitle);

  void section(std::string_view heading);
  void subsection(std::string_view heading);
  void paragraph(std::string_view text);
  void list(const std::vector<std::string>& items);
  void picture(const std::string& svg, std::string_view caption);
  /// caption  above the table
  void table(const Table& table, std::string_view caption = {});

  std::string finish() const;

 private:
  std::string body_;
  int figures_ = 0;
};

}  // namespace eigengrain::report
