#include "input/encoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "input/input.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::app {
namespace {

// Usual names of an encoder's channel.
constexpr std::array<const char*, 6> encoder_names{"encoder", "enc",   "encoder_count",
                                                   "counts",  "ticks", "angle"};

const Channel& encoder_channel(const Recording& recording, const EncoderFlags& flags) {
  if (!flags.channel.empty()) {
    if (const Channel* named = recording.find(flags.channel)) return *named;
    throw Failure(usage, fmt::format("{}: --encoder-channel: no channel {}", recording.source,
                                     flags.channel));
  }
  for (const char* name : encoder_names)
    if (const Channel* found = recording.find(name)) return *found;
  if (!flags.edges.empty() && recording.channels.size() == 1) return recording.channels.front();
  throw Failure(usage, fmt::format("{}: no encoder found: name its channel with --encoder-channel",
                                   recording.source));
}

// Value of the channel after which it repeats (0: it does not), and radians for one of its units.
struct EncoderScale {
  double modulus = 0.0, rad_per_unit = 0.0, step_rad = 0.0;
};

EncoderScale scale_of(const Channel& channel, const EncoderFlags& flags, const std::string& file) {
  const bool angle = channel.unit.quantity == Quantity::angle;
  if (angle) {
    EncoderScale scale{rad_per_turn / channel.unit.to_si, channel.unit.to_si, 0.0};
    if (flags.counts_per_turn)
      scale.step_rad = rad_per_turn / *flags.counts_per_turn;
    else
      scale.step_rad = signal::find_lsb(channel.values).value_or(0.0) * channel.unit.to_si;
    return scale;
  }
  if (channel.unit.quantity != Quantity::unknown && channel.unit.quantity != Quantity::counts)
    throw Failure(usage, fmt::format("{}: channel {}: expected counts or an angle, not {}", file,
                                     channel.name, channel.unit.symbol));
  if (!flags.counts_per_turn)
    throw Failure(usage, fmt::format("{}: channel {}: give --counts-per-turn N (quadrature counts)",
                                     file, channel.name));
  EncoderScale scale{flags.wrap.value_or(0.0), rad_per_turn / *flags.counts_per_turn,
                     rad_per_turn / *flags.counts_per_turn};
  if (flags.wrap) return scale;
  // A count that never leaves one turn wraps there.
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double value : channel.values) {
    if (std::isnan(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  if (least >= 0.0 && most < *flags.counts_per_turn && most - least > 0.9 * *flags.counts_per_turn)
    scale.modulus = *flags.counts_per_turn;
  return scale;
}

std::vector<double> times_of(const Recording& recording) {
  std::vector<double> times(recording.samples());
  for (std::size_t k = 0; k < times.size(); ++k) times[k] = recording.time.at(k);
  return times;
}

// A pulse of the index: time and angle of its middle, and how far the angle moves in a sample.
struct IndexPulse {
  double time_s = 0.0, angle_rad = 0.0, moved_rad = 0.0;
};

std::vector<IndexPulse> index_pulses(View<double> level,
                                     const std::vector<double>& angle_rad,
                                     const std::vector<double>& times) {
  const auto [least, most] = std::ranges::minmax(level);
  const double middle = 0.5 * (least + most);
  std::vector<IndexPulse> pulses;
  std::size_t count = 0;
  for (std::size_t k = 0; k < level.size() && most > least; ++k) {
    if (!(level[k] > middle) || std::isnan(angle_rad[k])) {
      count = 0;
      continue;
    }
    if (count++ == 0) pulses.emplace_back();
    IndexPulse& pulse = pulses.back();
    pulse.time_s += (times[k] - pulse.time_s) / static_cast<double>(count);
    pulse.angle_rad += (angle_rad[k] - pulse.angle_rad) / static_cast<double>(count);
    if (k > 0) pulse.moved_rad = std::abs(angle_rad[k] - angle_rad[k - 1]);
  }
  return pulses;
}

// Counts by which the turns between pulses differ from whole ones.
std::vector<signal::CountSlip> slips_of(const std::vector<IndexPulse>& pulses, double step_rad) {
  std::vector<signal::CountSlip> slips;
  for (std::size_t i = 1; i < pulses.size(); ++i) {
    const double moved = pulses[i].angle_rad - pulses[i - 1].angle_rad;
    const double off = moved - std::round(moved / rad_per_turn) * rad_per_turn;
    const double unsure =
        std::max(step_rad, std::hypot(pulses[i].moved_rad, pulses[i - 1].moved_rad));
    if (!(step_rad > 0.0) || std::abs(off) < 1.5 * unsure) continue;
    slips.push_back({0.5 * (pulses[i].time_s + pulses[i - 1].time_s), pulses[i - 1].time_s,
                     pulses[i].time_s, static_cast<int>(std::lround(off / step_rad))});
  }
  return slips;
}

// Counts and index of the recording with the accelerometers, or of a file of edges on its clock.
Recording edges_recording(const Recording& recording,
                          const EncoderFlags& flags,
                          const InputFlags& input,
                          double& begin_s) {
  InputFlags own;
  own.host = input.host;
  // Edges are not evenly spaced.
  Recording edges = with_rising_time(load(flags.edges, own, {}));
  if (recording.time.start_ns && edges.time.start_ns)
    begin_s = 1e-9 * static_cast<double>(*edges.time.start_ns - *recording.time.start_ns);
  return edges;
}

}  // namespace

void add_encoder_flags(CLI::App& verb, EncoderFlags& flags, const char* wanted) {
  CLI::Option* encoder = verb.add_flag("--encoder", flags.wanted, wanted);
  verb.add_option("--encoder-channel", flags.channel,
                  "the encoder's counts or angle (default: the channel encoder, counts, ticks or "
                  "angle)")
      ->type_name("NAME")
      ->needs(encoder);
  verb.add_option("--counts-per-turn", flags.counts_per_turn,
                  "quadrature counts of one turn of the encoder")
      ->type_name("N")
      ->needs(encoder)
      ->check(positive());
  verb.add_option(
          "--wrap", flags.wrap,
          "number of counts at which the counter wraps, such as 65536 (default: none, or one "
          "turn)")
      ->type_name("COUNTS")
      ->needs(encoder)
      ->check(positive());
  verb.add_option("--index", flags.index, "channel of the index pulse, where the angle is 0")
      ->type_name("NAME")
      ->needs(encoder);
  verb.add_option("--edges", flags.edges,
                  "file of the encoder's edges: time and count after each, on the clock of FILE")
      ->type_name("FILE")
      ->needs(encoder);
}

void read_encoder_too(const EncoderFlags& flags, InputFlags& input) {
  if (input.channels.empty() || !flags.edges.empty()) return;
  if (flags.channel.empty())
    throw Failure(usage, "--encoder with --channel: name the encoder with --encoder-channel");
  input.channels.push_back(flags.channel);
  if (!flags.index.empty()) input.channels.push_back(flags.index);
}

EncoderChannel encoder_of(const Recording& recording,
                          const EncoderFlags& flags,
                          const InputFlags& input,
                          std::vector<Note>& notes) {
  double begin_s = 0.0;
  const bool apart = !flags.edges.empty();
  Recording edges;
  if (apart) edges = edges_recording(recording, flags, input, begin_s);
  const Recording& from = apart ? edges : recording;
  const Channel& channel = encoder_channel(from, flags);
  const EncoderScale scale = scale_of(channel, flags, from.source);
  signal::UnwrappedAngle unwrapped =
      signal::unwrap_angle(channel.values, scale.modulus, scale.rad_per_unit);
  EncoderChannel out{.name = channel.name,
                     .fixes = {},
                     .step_rad = scale.step_rad,
                     .counts_per_turn = flags.counts_per_turn,
                     .has_index = false,
                     .absolute = channel.unit.quantity == Quantity::angle,
                     .index_slips = {}};
  if (unwrapped.glitches > 0)
    notes.push_back(
        {Severity::warning, fmt::format("{}: {} single values contradict their neighbours: ignored",
                                        channel.name, unwrapped.glitches)});
  std::vector<double> times = times_of(from);
  for (double& time : times) time += begin_s;
  if (!flags.index.empty()) {
    const Channel* index = from.find(flags.index);
    if (index == nullptr)
      throw Failure(usage, fmt::format("{}: --index: no channel {}", from.source, flags.index));
    const auto pulses = index_pulses(index->values, unwrapped.angle_rad, times);
    if (pulses.empty())
      throw Failure(bad_input,
                    fmt::format("{}: channel {}: no index pulse", from.source, flags.index));
    for (double& angle : unwrapped.angle_rad) angle -= pulses.front().angle_rad;
    out.has_index = true;
    out.index_slips = slips_of(pulses, scale.step_rad);
  }
  constexpr double smooth_std_rad = 1e-4, stamp_std_s = 1e-6;
  out.fixes =
      apart ? signal::fixes_of_edges(times, unwrapped.angle_rad, scale.step_rad, stamp_std_s)
            : signal::fixes_of_samples(times, unwrapped.angle_rad, scale.step_rad, smooth_std_rad);
  if (out.fixes.time_s.empty())
    throw Failure(bad_input, fmt::format("{}: channel {}: the encoder does not move", from.source,
                                         channel.name));
  return out;
}

}  // namespace proofmass::app
