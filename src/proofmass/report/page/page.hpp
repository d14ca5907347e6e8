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
  bool stacks = false;     ///< where it is narrow, that cell stands above the others of its row
  bool page_only = false;  ///< too wide or too detailed for a terminal
  bool long_list = false;  ///< may be cut short, as the JSON document has all rows
  std::vector<std::string> links = {};  ///< of the rows' first cells, to files beside the page
};

/// A figure, or what draws it: a result with a million samples is not copied into plots that nobody
/// asked for. What it refers to must live until then.
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

/// A short text under a word of its own, beside others.
struct Side {
  std::string label, text;
};

struct Section {
  std::string heading;
  std::string id = {};           ///< by which the contents and other pages link to it; unique
  std::string gist = {};         ///< a few words of summary, after its heading in the contents
  std::string digest = {};       ///< of a part: a line or two, in its place on a terminal
  std::vector<Side> sides = {};  ///< two beside each other, others below them
  std::vector<std::string> paragraphs = {};
  std::vector<std::string> points = {};  ///< an unnumbered list
  std::vector<Table> tables = {};
  std::vector<Plot> figures = {};
  std::vector<std::string> signatures = {};  ///< lines to be filled in by hand, with what they are
  bool new_sheet = false;                    ///< printed, it begins on a new sheet
  bool on_terminal = false;                  ///< text, points and tables are printed there, too
  std::vector<Section> parts = {};           ///< below all this, each under a smaller heading
};

/// One figure that answers the question, set large above everything else.
struct KeyFigure {
  std::string label, value;
  bool page_only = false;  ///< a table has it on a terminal
};

struct Page {
  std::string verb;
  std::string action = {};          ///< of a verb that has several: "show" of `sensor show`
  std::string title;                ///< "wheel1.csv and wheel2.csv"
  std::vector<std::string> inputs;  ///< files, with their size in samples and seconds
  std::string conclusion;           ///< what it comes to, in a sentence or two
  std::vector<KeyFigure> key_figures = {};
  std::vector<Note> notes = {};
  std::vector<Section> sections = {};
  bool contents = false;  ///< a list of the sections and parts that have an id, before them
  bool numbered = true;   ///< figures are, from 1
};

/// The page as HTML. All text is escaped here; nothing in it depends on the time or the machine.
[[nodiscard]] std::string html(const Page& page);

}  // namespace proofmass::report
