#include "fleet/shard.hpp"

#include <array>
#include <charconv>
#include <cstdlib>
#include <fmt/format.h>
#include <optional>
#include <string_view>

#include "cli/exit_status.hpp"

namespace proofmass::app {
namespace {

/// Environment variables of an engine: index of this task, number of tasks, and the first index.
struct ArrayVariables {
  const char *index, *count, *first;
};

// Source: SLURM, sbatch(1), "Job arrays"; Kubernetes, "Indexed Job"; AWS Batch, "Array jobs"; Open
// MPI, mpirun(1). Kubernetes does not state the number of tasks.
constexpr std::array<ArrayVariables, 4> engines{{
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN"},
    {"JOB_COMPLETION_INDEX", nullptr, nullptr},
    {"AWS_BATCH_JOB_ARRAY_INDEX", "AWS_BATCH_JOB_ARRAY_SIZE", nullptr},
    {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", nullptr},
}};

std::optional<std::size_t> count_in(std::string_view text) {
  std::size_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

std::optional<std::size_t> variable(const char* name) {
  const char* text = name == nullptr ? nullptr : std::getenv(name);
  return text == nullptr ? std::nullopt : count_in(text);
}

const ArrayVariables* engine_here() {
  for (const ArrayVariables& engine : engines)
    if (variable(engine.index)) return &engine;
  return nullptr;
}

fleet::Shard checked(std::size_t i, std::size_t n) {
  if (n < 1 || i >= n)
    throw Failure(usage,
                  fmt::format("--shard: expected I below N, counted from 0, not {}/{}", i, n));
  return {i, n};
}

}  // namespace

fleet::Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash != std::string::npos) {
    const auto i = count_in(std::string_view(text).substr(0, slash));
    const auto n = count_in(std::string_view(text).substr(slash + 1));
    if (!i || !n) throw Failure(usage, "--shard: expected I/N or N, not '" + text + "'");
    return checked(*i, *n);
  }
  const std::optional<std::size_t> given = text.empty() ? std::nullopt : count_in(text);
  if (!text.empty() && !given)
    throw Failure(usage, "--shard: expected I/N or N, not '" + text + "'");
  const ArrayVariables* engine = engine_here();
  if (engine == nullptr) {
    if (!given) return {};
    throw Failure(usage,
                  "--shard " + text +
                      ": no environment variable has this shard's number: give I/N, from 0 on");
  }
  const auto n = given ? given : variable(engine->count);
  if (!n)
    throw Failure(usage,
                  fmt::format("--shard: {} is set, but the number of shards is unknown: give "
                              "--shard N",
                              engine->index));
  return checked(*variable(engine->index) - variable(engine->first).value_or(0), *n);
}

}  // namespace proofmass::app
