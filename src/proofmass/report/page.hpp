#pragma once

#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/report/figure.hpp"

// One self-contained page: no script, no network, no second file.
namespace proofmass::report {

struct Table {
  std::string caption;
  std::vector<std::string> head;               ///< empty: none
  std::vector<std::vector<std::string>> rows;  ///< plain text; the first cell names the row
};

struct Section {
  std::string heading;
  std::vector<std::string> paragraphs = {};
  std::vector<std::string> points = {};  ///< an unnumbered list
  std::vector<Table> tables = {};
  std::vector<Figure> figures = {};
  std::vector<std::string> signatures = {};  ///< lines to be filled in by hand, with what they are
  bool new_sheet = false;                    ///< printed, it begins on a new sheet
};

/// One figure that answers the question, set large above everything else.
struct KeyFigure {
  std::string label, value;
};

struct Page {
  std::string verb;
  std::string title;                ///< "wheel1.csv and wheel2.csv"
  std::vector<std::string> inputs;  ///< files, with their size in samples and seconds
  std::string conclusion;           ///< what it comes to, in a sentence or two
  std::vector<KeyFigure> key_figures = {};
  std::vector<Note> notes = {};
  std::vector<Section> sections = {};
};

/// The page as HTML. All text is escaped here; nothing in it depends on the time or the machine.
[[nodiscard]] std::string html(const Page& page);

}  // namespace proofmass::report
