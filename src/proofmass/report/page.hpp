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
  bool stacks = false;  ///< where it is narrow, that cell stands above the others of its row
  std::vector<std::string> links = {};  ///< of the rows' first cells, to files beside the page
};

/// A short text under a word of its own, beside others.
struct Side {
  std::string label, text;
};

struct Section {
  std::string heading;
  std::string id = {};           ///< by which the contents and other pages link to it; unique
  std::string gist = {};         ///< what it comes to, behind its heading in the contents
  std::vector<Side> sides = {};  ///< two beside each other, others below them
  std::vector<std::string> paragraphs = {};
  std::vector<std::string> points = {};  ///< an unnumbered list
  std::vector<Table> tables = {};
  std::vector<Figure> figures = {};
  std::vector<std::string> signatures = {};  ///< lines to be filled in by hand, with what they are
  bool new_sheet = false;                    ///< printed, it begins on a new sheet
  std::vector<Section> parts = {};           ///< below all this, each under a smaller heading
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
  bool contents = false;  ///< a list of the sections and parts that have an id, before them
  bool numbered = true;   ///< figures are, from 1
};

/// The page as HTML. All text is escaped here; nothing in it depends on the time or the machine.
[[nodiscard]] std::string html(const Page& page);

}  // namespace proofmass::report
