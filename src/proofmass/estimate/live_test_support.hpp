#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "proofmass/core/live_analysis.hpp"

// Shared by the tests of the online analyses.
namespace proofmass::estimate::test {

/// Samples as delivered by a recorder.
struct Stream {
  std::vector<double> stamps_s;
  std::vector<std::vector<double>> channels;

  [[nodiscard]] Block block(std::size_t first, std::size_t rows) const {
    Block block;
    block.first = first;
    for (const auto& channel : channels)
      block.channels.push_back(View<double>(channel).subspan(first, rows));
    block.stamps_s = View<double>(stamps_s).subspan(first, rows);
    return block;
  }
};

/// Output and messages of an analysis fed in blocks of `piece` samples.
struct Fed {
  Rows rows;
  std::vector<Note> notes;

  [[nodiscard]] bool says(const std::string& words) const {
    return std::ranges::any_of(
        notes, [&](const Note& note) { return note.text.find(words) != std::string::npos; });
  }
  [[nodiscard]] bool recommends(const std::string& option) const {
    return std::ranges::any_of(notes, [&](const Note& note) {
      return std::ranges::find(note.advice, option, &Advice::option) != note.advice.end();
    });
  }
};

inline Fed feed(LiveAnalysis& analysis, const Stream& stream, std::size_t piece) {
  Fed fed;
  const auto listen = [&] {
    for (Note& note : analysis.take_notes()) fed.notes.push_back(std::move(note));
  };
  for (std::size_t first = 0; first < stream.stamps_s.size(); first += piece) {
    const std::size_t rows = std::min(piece, stream.stamps_s.size() - first);
    (void)analysis.add(stream.block(first, rows), fed.rows).value();
    listen();
  }
  (void)analysis.finish(fed.rows).value();
  listen();
  return fed;
}

/// Bitwise equal, NaN equal to NaN.
inline bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(
      a, b, [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

inline bool same(const Rows& a, const Rows& b) {
  return same(a.stamps_s, b.stamps_s) &&
         std::ranges::equal(a.channels, b.channels,
                            [](const auto& x, const auto& y) { return same(x, y); });
}

/// Column of that name.
inline const std::vector<double>& column(const LiveAnalysis& analysis,
                                         const Fed& fed,
                                         const std::string& name) {
  const auto& columns = analysis.columns();
  const auto at = std::ranges::find(columns, name, &Channel::name);
  return fed.rows.channels.at(static_cast<std::size_t>(at - columns.begin()));
}

/// An analysis and its output for a stream.
struct Followed {
  std::unique_ptr<LiveAnalysis> live;
  Fed fed{};
  [[nodiscard]] const std::vector<double>& operator[](const std::string& name) const {
    return column(*live, fed, name);
  }
};

inline Followed followed(std::unique_ptr<LiveAnalysis> live,
                         const Stream& stream,
                         std::size_t piece) {
  Followed run{std::move(live)};
  run.fed = feed(*run.live, stream, piece);
  return run;
}

}  // namespace proofmass::estimate::test
