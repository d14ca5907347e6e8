#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/thesis/programme.hpp"

namespace proofmass::thesis {

struct ThesisReport {
  std::vector<std::string> inputs;  ///< files, as named by the user
  std::uint64_t seed = 1;           ///< of the simulation
  std::size_t runs = 0;             ///< simulated at each speed
  std::vector<Note> notes = {};     ///< from reading the files
  Programme programme = {};
};

/// Each table and figure of the thesis compared with ours, by chapter: items[] of {id, title,
/// thesis, ours, note}. It refers to the report, which must outlive it.
[[nodiscard]] report::Document describe(const ThesisReport& report);

}  // namespace proofmass::thesis
