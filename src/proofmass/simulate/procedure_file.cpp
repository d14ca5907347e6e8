#include "proofmass/simulate/procedure_file.hpp"

#include <array>
#include <utility>

#include "proofmass/simulate/procedure/fields.hpp"
#include "proofmass/simulate/procedure/slide_fields.hpp"
#include "proofmass/simulate/rig/description.hpp"
#include "proofmass/simulate/rig/fields.hpp"

namespace proofmass::simulate {

static auto choices(Procedure /*which*/) {
  std::array<std::pair<Procedure, std::string_view>, 5> all{};
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto procedure = static_cast<Procedure>(k);
    all[k] = {procedure, name_of(procedure)};
  }
  return all;
}

static auto choices(SlideProfile /*which*/) {
  return std::to_array<std::pair<SlideProfile, std::string_view>>(
      {{SlideProfile::minimum_jerk, "minimum-jerk"}, {SlideProfile::harmonic, "harmonic"}});
}

static auto choices(TableAxis /*which*/) {
  return std::to_array<std::pair<TableAxis, std::string_view>>(
      {{TableAxis::x, "x"}, {TableAxis::y, "y"}, {TableAxis::z, "z"}});
}

namespace {

using description::read_section;
using description::Take;

/// The sections in order; each is visited by the function beside its name.
template <class Options, class Section>
void for_each_section(Options& o, Section&& section) {
  section("timing", [&](auto&& visit) { visit_timing(o.timing, visit); });
  section("table", [&](auto&& visit) { visit_table(o.table, visit); });
  section("hand", [&](auto&& visit) { visit_hand(o.hand, visit); });
  section("slide", [&](auto&& visit) { visit_slide(o.slide, visit); });
  section("supply", [&](auto&& visit) { visit_bench_supply(o.supply, visit); });
  section("daq", [&](auto&& visit) { visit_daq(o.daq, visit); });
  section("sensor", [&](auto&& visit) { visit_bench_sensor(o.sensor, visit); });
}

ProcedureOptions read_options(toml::table& root, Procedure procedure) {
  ProcedureOptions o = default_options(procedure);
  const toml::node* named = root.get("procedure");
  if (named != nullptr) description::Fill{*named, "procedure", 1.0}(o.procedure);
  if (o.procedure != procedure)
    description::fail(*named, "procedure",
                      "is " + std::string(name_of(o.procedure)) + ", but " +
                          std::string(name_of(procedure)) + " was asked for");
  visit_procedure(o, Take{root});
  for_each_section(o, [&](std::string_view name, auto read) { read_section(root, name, read); });
  description::must_be_empty(root, "a procedure's description");
  return o;
}

}  // namespace

Result<ProcedureOptions> parse_procedure_file(std::string_view text,
                                              std::string_view name,
                                              Procedure procedure) {
  const auto read = [procedure](toml::table& root) { return read_options(root, procedure); };
  return description::parse<ProcedureOptions>(text, name, read);
}

Result<ProcedureOptions> read_procedure_file(const std::string& path, Procedure procedure) {
  const Result<std::string> text = description::text_of(path, "a procedure's description");
  if (!text) return text.error();
  return parse_procedure_file(*text, path, procedure);
}

std::string format_procedure_file(const ProcedureOptions& options) {
  std::string out =
      "# A procedure for `proofmass simulate`. A key that is left out keeps its default.\n\n";
  visit_procedure(options, description::Print{out});
  for_each_section(options, [&](std::string_view name, auto print) {
    out += "\n[" + std::string(name) + "]\n";
    print(description::Print{out});
  });
  return out;
}

}  // namespace proofmass::simulate
