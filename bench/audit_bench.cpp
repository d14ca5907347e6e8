// Audits channels in blocks and, for comparison in the same run, sums the same values from memory.
// The blocks are taken from one table repeatedly, so that the recording's length does not depend on
// memory.
//
//   audit_bench [millions of values a channel, 200]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

#include "measure.hpp"
#include "proofmass/signal/running_audit.hpp"

namespace {

using proofmass::Block;
using proofmass::Recording;
using proofmass::View;

// Longer than the last-level cache, and a whole number of blocks.
constexpr std::size_t table_rows = std::size_t{1} << 22, block_rows = 8192, channels = 3;
using Table = std::vector<std::vector<double>>;

double seconds_of(const std::function<void()>& work) {
  const double start = proofmass::cpu_s();
  work();
  return proofmass::cpu_s() - start;
}

double normal() {
  static std::mt19937_64 random(5);
  static std::normal_distribution<double> distribution;
  return distribution(random);
}

Table table_of(const std::function<double(std::size_t)>& value) {
  Table table(channels, std::vector<double>(table_rows));
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t k = 0; k < table_rows; ++k) table[c][k] = value(k) + (c == 0 ? 1000.0 : 0.0);
  return table;
}

double judge(const Table& table, std::size_t rows) {
  Recording head;
  head.time.rate_hz = 1000.0;
  for (const char* name : {"Acc_X", "Acc_Y", "Acc_Z"})
    head.channels.push_back({name, *proofmass::parse_unit("m/s^2"), {}});
  proofmass::signal::RunningAudit audit(head);
  for (std::size_t done = 0; done < rows; done += block_rows) {
    Block block;
    block.first = done;
    for (const std::vector<double>& values : table)
      block.channels.push_back(View<double>(values).subspan(done % table_rows, block_rows));
    audit.add(block);
  }
  return audit.finish(head).channels[0].moments.mean;
}

double add_up(const Table& table, std::size_t rows) {
  double sums[8] = {};
  for (std::size_t done = 0; done < rows; done += block_rows)
    for (const std::vector<double>& values : table) {
      const double* x = values.data() + done % table_rows;
      for (std::size_t k = 0; k < block_rows; k += 8)
        for (std::size_t lane = 0; lane < 8; ++lane) sums[lane] += x[k + lane];
    }
  return sums[0] + sums[7];
}

void run(const char* name, std::size_t rows, const std::function<double(std::size_t)>& value) {
  const Table table = table_of(value);
  const double values = static_cast<double>(rows * channels);
  double checksum = 0.0, audit_s = 1e300, sum_s = 1e300;
  for (int i = 0; i < 3; ++i) {
    audit_s = std::min(audit_s, seconds_of([&] { checksum += judge(table, rows); }));
    sum_s = std::min(sum_s, seconds_of([&] { checksum += add_up(table, rows); }));
  }
  std::printf("%-26s audit %5.2f ns a value   adding up %5.2f ns (%.1f GB/s)   (checksum %g)\n",
              name, 1e9 * audit_s / values, 1e9 * sum_s / values, 8e-9 * values / sum_s, checksum);
}

}  // namespace

int main(int argc, char** argv) {
  const double millions = argc > 1 ? std::strtod(argv[1], nullptr) : 200.0;
  const std::size_t rows = (static_cast<std::size_t>(millions * 1e6) / block_rows + 1) * block_rows;
  run("continuous noise", rows, [](std::size_t) { return normal(); });
  run("noise of 4 steps", rows, [](std::size_t) { return std::round(4.0 * normal()); });
  run("noise of 100 steps", rows, [](std::size_t) { return std::round(100.0 * normal()); });
  run("clipped swing", rows, [](std::size_t k) {
    const double swing = 3000.0 * std::sin(0.001 * static_cast<double>(k));
    return std::clamp(std::round(swing + 4.0 * normal()), -2000.0, 2000.0);
  });
  run("one in a hundred missing", rows,
      [](std::size_t k) { return k % 100 == 7 ? std::nan("") : normal(); });
  return 0;
}
