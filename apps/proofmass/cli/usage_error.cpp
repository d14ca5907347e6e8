#include "cli/usage_error.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <numeric>
#include <regex>

#include "cli/help_format.hpp"

namespace proofmass::app {
namespace {

// Number of insertions, deletions, substitutions and transpositions of adjacent letters. Source:
// Damerau, "A technique for computer detection and correction of spelling errors", Comm. ACM 7(3),
// 1964, in the variant that edits no substring twice (optimal string alignment).
std::size_t edits_between(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before, last(b.size() + 1), now(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + change});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before = last;
    last = now;
  }
  return last.back();
}

std::string meant(const std::optional<std::string>& word) {
  return word ? fmt::format(": did you mean {}?", *word) : std::string();
}

// "--raduis=0.1" -> "--raduis"
std::string flag_of(const std::string& argument) {
  return argument.substr(0, argument.find('='));
}

// Unrecognised arguments. CLI11 stores them in some cases, and only names them in others.
std::vector<std::string> extras_of(const CLI::App& verb, const CLI::ParseError& error) {
  std::vector<std::string> extras = verb.remaining();
  const std::string text = error.what(), lead = "not expected: ";
  const std::size_t at = text.find(lead);
  if (extras.empty() && at != std::string::npos)
    extras = CLI::detail::split(text.substr(at + lead.size()), ' ');
  return extras;
}

std::string unknown_flag(const CLI::App& verb, const std::string& argument) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  const std::string flag = flag_of(argument);
  return fmt::format("{} has no flag {}{}", verb.get_name(), flag, meant(nearest(flag, flags)));
}

bool takes_output(const CLI::App& verb) {
  return verb.get_option_no_throw("--output") != nullptr;
}

std::string too_many(const CLI::App& verb, const std::string& argument) {
  std::string text = fmt::format("{}: nothing is expected at '{}'", verb.get_name(), argument);
  if (takes_output(verb) && argument.find('.') != std::string::npos)
    text += fmt::format("; a file to be written is given as -o {}", argument);
  return text;
}

std::string unexpected(const CLI::App& verb, const std::vector<std::string>& extras) {
  const auto flag = std::ranges::find_if(
      extras, [](const std::string& one) { return one.size() > 1 && one.front() == '-'; });
  return flag != extras.end() ? unknown_flag(verb, *flag) : too_many(verb, extras.front());
}

// "FILE: At Most 2 required but received 3" -> "wheel takes 2 FILEs at most, not 3"
std::optional<std::string> count_words(const CLI::App& verb, const std::string& text) {
  static const std::regex most(R"(^(\S+): At Most (\d+) required but received (\d+))");
  std::smatch found;
  if (!std::regex_search(text, found, most)) return std::nullopt;
  return fmt::format("{} takes at most {} of {}, not {}", verb.get_name(), found.str(2),
                     found.str(1), found.str(3));
}

// "--unit: furlong not in {g,mg}" -> "--unit: expected g or mg, not 'furlong'"
std::optional<std::string> choice_words(const std::string& text) {
  static const std::regex member(R"(^(\S+): (.*) not in \{(.*)\}$)");
  std::smatch found;
  if (!std::regex_search(text, found, member)) return std::nullopt;
  const std::vector<std::string> values = CLI::detail::split(found.str(3), ',');
  return fmt::format("{}: expected {}, not '{}'{}", found.str(1),
                     fmt::format("{}", fmt::join(values, ", ")), found.str(2),
                     meant(nearest(found.str(2), values)));
}

std::string objection(const CLI::App& verb, const CLI::ParseError& error) {
  std::string text = error.what();
  std::ranges::replace(text, '\n', ' ');
  const auto is = [&](CLI::ExitCodes code) {
    return error.get_exit_code() == static_cast<int>(code);
  };
  const std::vector<std::string> extras = extras_of(verb, error);
  if (is(CLI::ExitCodes::ExtrasError) && !extras.empty()) return unexpected(verb, extras);
  // Missing arguments before superfluous ones, which may be the reason.
  if (is(CLI::ExitCodes::RequiredError)) {
    const auto is_flag = [](const std::string& one) { return one.starts_with("--"); };
    const auto flag = std::ranges::find_if(extras, is_flag);
    if (flag != extras.end()) return unknown_flag(verb, *flag);
    if (!extras.empty()) return too_many(verb, extras.front());
    return fmt::format("{}: {}", verb.get_name(), text);
  }
  if (const auto words = count_words(verb, text)) return *words;
  return choice_words(text).value_or(text);
}

}  // namespace

std::optional<std::string> nearest(const std::string& word,
                                   const std::vector<std::string>& candidates) {
  const auto lower = [](std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
  };
  std::optional<std::string> best;
  std::size_t fewest = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t edits = edits_between(lower(word), lower(candidate));
    // A short word must not be replaced entirely.
    if (edits >= fewest || 2 * edits >= candidate.size() + 1) continue;
    fewest = edits;
    best = candidate;
  }
  return best;
}

std::string unknown_verb(const CLI::App& app, const std::string& word) {
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    verbs.push_back(verb->get_name());
  return fmt::format("no verb '{}'{} see proofmass --help", word,
                     nearest(word, verbs) ? meant(nearest(word, verbs)) : ":");
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const auto used = app.get_subcommands();
  const CLI::App& verb = used.empty() ? app : *used.front();
  const std::string text = objection(verb, error);
  return fmt::format("{}{} see proofmass {}--help", text, text.ends_with('?') ? "" : ":",
                     used.empty() ? "" : verb.get_name() + " ");
}

}  // namespace proofmass::app
