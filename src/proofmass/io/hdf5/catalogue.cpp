#include "proofmass/io/hdf5/catalogue.hpp"

#include <algorithm>

#include "proofmass/io/bytes/subprocess_words.hpp"

namespace proofmass::io::hdf5 {
namespace {

/// True if that many values are possible.
bool is_possible(const Dataset& dataset) {
  constexpr std::uint64_t most_figures = std::uint64_t{1} << 48;
  std::uint64_t figures = 1;
  for (const std::uint64_t length : dataset.shape)
    if (__builtin_mul_overflow(figures, length, &figures) || length > most_figures) return false;
  if (dataset.is_compound && dataset.shape.size() != 2) return false;
  return figures <= most_figures && !dataset.path.empty() &&
         dataset.group_length < dataset.path.size();
}

Dataset read_dataset(WordReader& from) {
  constexpr std::size_t most_dimensions = 32;
  Dataset dataset;
  dataset.path = from.text();
  dataset.address = from.bytes_text(usual_text);
  dataset.type = from.text();
  dataset.shape = from.list(most_dimensions, [&] { return from.number(); });
  dataset.group_length = from.number();
  dataset.is_complex = from.number() != 0;
  dataset.is_compound = from.number() != 0;
  dataset.figure = from.figure();
  return dataset;
}

Attribute decode_attribute(WordReader& from) {
  constexpr std::size_t most_texts = 64;
  Attribute attribute;
  attribute.owner = from.text();
  attribute.name = from.text();
  attribute.texts = from.list(most_texts, [&] { return from.text(); });
  attribute.figure = from.figure();
  attribute.integer = from.integer();
  return attribute;
}

}  // namespace

std::string encode(const Catalogue& catalogue) {
  WordWriter to;
  to.list(catalogue.datasets, [&](const Dataset& dataset) {
    to.text(dataset.path);
    to.text(dataset.address);
    to.text(dataset.type);
    to.list(dataset.shape, [&](std::uint64_t length) { to.number(length); });
    to.number(dataset.group_length);
    to.number(dataset.is_complex ? 1 : 0);
    to.number(dataset.is_compound ? 1 : 0);
    to.figure(dataset.figure);
  });
  to.list(catalogue.attributes, [&](const Attribute& attribute) {
    to.text(attribute.owner);
    to.text(attribute.name);
    to.list(attribute.texts, [&](const std::string& text) { to.text(text); });
    to.figure(attribute.figure);
    to.integer(attribute.integer);
  });
  to.list(catalogue.skipped, [&](const std::string& text) { to.text(text); });
  to.list(catalogue.runs, [&](const Label& run) {
    to.text(run.text);
    to.number(run.first);
    to.number(run.last);
  });
  to.text(catalogue.run_channel);
  to.number(catalogue.is_cut ? 1 : 0);
  return to.take();
}

Result<Catalogue> decode(std::string_view bytes) {
  WordReader from(bytes);
  Catalogue catalogue;
  catalogue.datasets = from.list(most_objects, [&] { return read_dataset(from); });
  catalogue.attributes = from.list(most_objects, [&] { return decode_attribute(from); });
  catalogue.skipped = from.list(most_objects, [&] { return from.text(); });
  catalogue.runs = from.list(most_runs, [&] {
    Label run;
    run.text = from.text();
    run.first = from.number();
    run.last = from.number();
    return run;
  });
  catalogue.run_channel = from.text();
  catalogue.is_cut = from.number() != 0;
  if (!from.is_good() || !from.is_at_end() || !std::ranges::all_of(catalogue.datasets, is_possible))
    return Error{Errc::corrupt, "is damaged: its contents cannot be listed"};
  return catalogue;
}

}  // namespace proofmass::io::hdf5
