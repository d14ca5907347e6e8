#include "fleet/arguments.hpp"

#include <utility>

#include "fleet/command.hpp"

namespace proofmass::app {
namespace {

const CLI::App* verb_named(const CLI::App& app, const std::string& name) {
  const auto found =
      app.get_subcommands([&](const CLI::App* verb) { return verb->get_name() == name; });
  return found.empty() ? nullptr : found.front();
}

const CLI::Option* option_of(const CLI::App* verb, const std::string& word) {
  return verb == nullptr ? nullptr : verb->get_option_no_throw(word.substr(0, word.find('=')));
}

// Whether the value of the option is the next word.
bool takes_next(const CLI::Option* option, const std::string& word) {
  return option != nullptr && option->get_items_expected_max() > 0 &&
         word.find('=') == std::string::npos;
}

}  // namespace

void take_verb_flags(const CLI::App& app, const Verb& fleet, std::vector<std::string>& arguments) {
  const CLI::App* own_verb = verb_named(app, fleet.text.name);
  const CLI::App* verb = nullptr;
  std::vector<std::string> flags, kept;
  bool is_inside = false;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string& word = arguments[k];
    const bool is_flag = word.size() > 1 && word.front() == '-';
    const CLI::Option* own = is_flag ? option_of(own_verb, word) : nullptr;
    const CLI::Option* other = is_flag && own == nullptr ? option_of(verb, word) : nullptr;
    std::vector<std::string>& into = other != nullptr ? flags : kept;
    into.push_back(word);
    const CLI::Option* option = own != nullptr ? own : other;
    if (takes_next(option, word) && k + 1 < arguments.size()) {
      into.push_back(arguments[++k]);
    } else if (!is_flag) {
      if (is_inside && verb == nullptr) verb = verb_named(app, word);
      is_inside = is_inside || word == fleet.text.name;
    }
  }
  arguments = std::move(kept);
  std::any_cast<const std::shared_ptr<FleetCommand>&>(fleet.command)->flags = std::move(flags);
}

}  // namespace proofmass::app
