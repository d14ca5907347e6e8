#pragma once

#include <concepts>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/report/page/figure.hpp"

// One self-contained page: no network, no second file, readable without its script.
namespace proofmass::report {

struct Table {
  std::string caption;
  std::vector<std::string> head;               ///< empty: none
  std::vector<std::vector<std::string>> rows;  ///< plain text; the first cell names the row
  bool stacks = false;     ///< if narrow, the first cell is placed above the rest of its row
  bool page_only = false;  ///< too wide or too detailed for a terminal
  bool long_list = false;  ///< may be cut, since the JSON document has all rows
  std::vector<std::string> links = {};  ///< targets of the first cells: files beside the page
};

/// A figure, or a function that draws it, so that a result with a million samples is copied into
/// plots only on request. What the function refers to must outlive that.
class Plot {
 public:
  Plot(Figure figure)  // NOLINT(google-explicit-constructor)
      : draw_([figure = std::move(figure)] { return figure; }) {}
  template <std::invocable Draw>
  Plot(Draw draw)  // NOLINT(google-explicit-constructor)
      : draw_(std::move(draw)) {}

  [[nodiscard]] Figure draw() const { return draw_(); }

 private:
  std::function<Figure()> draw_;
};

[[nodiscard]] inline std::vector<Plot> plots(std::vector<Figure> figures) {
  return {std::make_move_iterator(figures.begin()), std::make_move_iterator(figures.end())};
}

/// A short text with a label, set beside others.
struct Side {
  std::string label, text;
};

struct Section {
  std::string heading;
  std::string id = {};           ///< unique anchor for the contents and other pages
  std::string gist = {};         ///< short summary after the heading in the contents
  std::string digest = {};       ///< for a part: a line or two that replace it on a terminal
  std::vector<Side> sides = {};  ///< set in two columns
  std::vector<std::string> paragraphs = {};
  std::vector<std::string> points = {};  ///< an unnumbered list
  std::vector<Table> tables = {};
  std::vector<Plot> figures = {};
  std::vector<std::string> signatures = {};  ///< lines to be filled in by hand, with labels
  bool new_sheet = false;                    ///< in print, starts a new sheet
  bool on_terminal = false;                  ///< text, points and tables are also printed on the
                                             ///< terminal
  std::vector<Section> parts = {};           ///< subsections, with smaller headings
};

/// One main result, set large at the top.
struct KeyFigure {
  std::string label, value;
  bool page_only = false;  ///< on a terminal a table has it
};

struct Page {
  std::string verb;
  std::string action = {};          ///< for a verb with several: "show" of `sensor show`
  std::string title;                ///< "wheel1.csv and wheel2.csv"
  std::vector<std::string> inputs;  ///< files, with their size in samples and seconds
  std::string conclusion;           ///< result in a sentence or two
  std::vector<KeyFigure> key_figures = {};
  std::vector<Note> notes = {};
  std::vector<Section> sections = {};
  bool contents = false;  ///< list the sections and parts that have an id before them
  bool numbered = true;   ///< number the figures from 1
};

/// The page as HTML. All text is escaped here; the page does not depend on the time or the machine.
[[nodiscard]] std::string html(const Page& page);

}  // namespace proofmass::report
