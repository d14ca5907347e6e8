#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "proofmass/acquire/framing_clock.hpp"

// Texts that bring a name with each figure.
namespace proofmass::acquire {

/// Called with each figure: NaN where there is a word instead; `exact` where it is a whole number.
using KeyVisit =
    std::function<void(std::string_view key, double value, const std::optional<Tick>& exact)>;

/// One line of "x:1.02,y:0.3", in any order, with = for :, and ; tab or blank for the comma; a JSON
/// object, flattened to "acc.x"; an OSC message or bundle. False if it is none of these; some of it
/// may have been visited by then.
[[nodiscard]] bool visit_keys(std::string_view line, const KeyVisit& visit);

/// Whether a text begins as an OSC message or bundle does, which may hold any byte.
[[nodiscard]] bool is_osc(std::string_view packet);
/// Arguments of "/accxyz ,fff" are accxyz.0, accxyz.1, accxyz.2; a single one is accxyz.
/// Source: M. Wright, The Open Sound Control 1.0 Specification (2002).
[[nodiscard]] bool visit_osc(std::string_view packet, const KeyVisit& visit);

}  // namespace proofmass::acquire
