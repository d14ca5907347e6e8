#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// A USB-6009 as its manual describes it: 8 single-ended or 4 differential inputs, one converter
// behind a multiplexer, 48 000 samples a second over all channels.
// Source: National Instruments, "NI USB-6008/6009 User Guide and Specifications" (371303).
namespace standin {

/// Some cards of the stand-in go wrong, each in its way.
enum class Fault {
  none,
  buffer_overrun,  ///< after 200 rows, once: 50 rows were taken that nobody can read
  fifo_overflow,   ///< after 200 rows, once, in the card
  overruns_only,   ///< at each reading: not one row comes
  unplugged,       ///< after 205 rows
  unreachable,     ///< when it is started
  silent,          ///< no row ever comes
  short_reads,     ///< 60 rows a reading at most
  hangs,           ///< a reading never returns
  wild_rate,       ///< it grants a rate that cannot be
};

struct Card {
  std::string_view name;
  Fault fault;
};
/// nullptr: none of that name.
const Card* card_of(std::string_view device);
enum Terminals : std::int32_t { by_default = -1, rse = 10083, nrse = 10078, differential = 10106 };

struct Range {
  double low, high;
};
/// Of a differential input; a single-ended one has the widest but one only.
std::span<const Range> ranges();

struct Channel {
  std::string name;  ///< "Dev1/ai0"
  unsigned index;
  Terminals terminals;
  Range range;
};

/// Why a channel cannot be had.
struct Refusal {
  std::int32_t status;
  std::string words;
};

inline constexpr unsigned inputs = 8;
inline constexpr double most_samples_per_s = 48'000.0;

/// The terminals that the card takes for an input. nullopt: it has none such.
std::optional<Terminals> granted_terminals(unsigned index, std::int32_t asked);
/// The narrowest range that holds what is asked for. nullopt: none does.
std::optional<Range> granted_range(Terminals terminals, double lowest, double highest);
/// The timebase divided by a whole number: the next rate that is not below. 0: there is none.
double granted_rate_hz(double asked_hz, std::size_t channels);

/// What the converter reads of an input in a row: a ramp of 1 mV a row on the first, sines on the
/// others.
double reading(const Channel& channel, std::uint64_t row, double time_s);

}  // namespace standin
