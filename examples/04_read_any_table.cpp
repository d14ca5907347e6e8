// A logger's table, read from memory: what the reader detects by itself, and what it reports.
#include <cstdio>
#include <span>
#include <string>

#include "proofmass/io/read_recording.hpp"

namespace pm = proofmass;

int main() {
  const std::string text =
      "# logger 7, bench 2\n"
      "Time_us;Acc_X (g);Acc_Y (g)\n"
      "1000000;0,0021;-0,9987\n"
      "1005000;0,0034;-0,9991\n"
      "1010000;;-0,9979\n"
      "1015000;0,0029;-0,9984\n";
  const auto recording =
      pm::io::read_recording(std::as_bytes(std::span(text)), "logger7.csv", {}).value();

  std::printf("%s, %zu samples at %g Hz\n", recording.format.c_str(), recording.samples(),
              recording.time.rate_hz);
  for (const pm::Channel& channel : recording.channels)
    std::printf("%s in %s: first %g, in SI %g m/s^2\n", channel.name.c_str(),
                channel.unit.symbol.c_str(), channel.values.front(),
                channel.unit.si(channel.values.front()));
  for (const pm::Note& note : recording.notes) std::printf("note: %s\n", note.text.c_str());
  return recording.channels.size() == 2 ? 0 : 1;
}
