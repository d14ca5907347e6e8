#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "proofmass/acquire/framing/clock.hpp"

// Text formats with a name for each value.
namespace proofmass::acquire {

/// Called for each value: NaN if it is a word; `exact` if it is an integer.
using KeyVisit =
    std::function<void(std::string_view key, double value, const std::optional<Tick>& exact)>;

/// One line of "x:1.02,y:0.3", in any order, with = instead of :, and ; tab or blank instead of the
/// comma; a JSON object, flattened to "acc.x"; an OSC message or bundle. False if it is none of
/// these; part of it may have been visited by then.
[[nodiscard]] bool visit_keys(std::string_view line, const KeyVisit& visit);

/// True if a text begins like an OSC message or bundle, which may contain any byte.
[[nodiscard]] bool is_osc(std::string_view packet);
/// Arguments of "/accxyz ,fff" are accxyz.0, accxyz.1, accxyz.2; a single one is accxyz. Source: M.
/// Wright, The Open Sound Control 1.0 Specification (2002).
[[nodiscard]] bool visit_osc(std::string_view packet, const KeyVisit& visit);

}  // namespace proofmass::acquire
