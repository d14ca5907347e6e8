#include "cli/completion.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "cli/help_format.hpp"
#include "proofmass/acquire/source.hpp"
#include "record/live_source.hpp"

namespace proofmass::app {
namespace {

using Options = std::vector<const CLI::Option*>;

// Command line before the word to be completed.
struct Typed {
  const CLI::App* verb = nullptr;
  const CLI::Option* open = nullptr;  ///< option that expects a value next
  std::size_t positionals = 0;
  Options given{};
};

// Lines of the answer; only those that begin with `word` are kept.
class Answer {
 public:
  explicit Answer(std::string word) : word_(std::move(word)) {}
  void offer(const std::string& candidate, const std::string& what) {
    if (candidate.starts_with(word_)) text_ += candidate + "\t" + what + "\n";
  }
  void add(const std::string& line) { text_ += line + "\n"; }
  [[nodiscard]] const std::string& word() const { return word_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string word_, text_;
};

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

const CLI::App* verb_of(const CLI::App& app, const std::string& name) {
  const auto found =
      app.get_subcommands([&](const CLI::App* verb) { return verb->get_name() == name; });
  return found.empty() ? nullptr : found.front();
}

Typed read(const CLI::App& app, const std::vector<std::string>& words) {
  Typed typed;
  for (std::size_t k = 0; k + 1 < words.size(); ++k) {
    const std::string& word = words[k];
    if (typed.open != nullptr) {
      typed.open = nullptr;
    } else if (typed.verb == nullptr) {
      typed.verb = verb_of(app, word);
    } else if (word.size() < 2 || word.front() != '-') {
      ++typed.positionals;
    } else if (const auto* option =
                   typed.verb->get_option_no_throw(word.substr(0, word.find('=')))) {
      typed.given.push_back(option);
      if (takes_value(*option) && word.find('=') == std::string::npos) typed.open = option;
    }
  }
  return typed;
}

void offer_files(const std::string& type, const std::string& prefix, Answer& answer) {
  answer.add(":files");
  const std::size_t dot = type.find('.');
  if (dot != std::string::npos) answer.add(":ending " + type.substr(dot + 1));
  if (!prefix.empty()) answer.add(":prefix " + prefix);
}

// The choices in "sim:wheel|static?rate=200".
std::vector<std::string> choices(const acquire::SourceKind& kind) {
  const std::size_t start = kind.scheme.size() + 1, end = kind.grammar.find('?');
  const std::string rest = kind.grammar.substr(start, end == std::string::npos ? end : end - start);
  if (rest.find('|') == std::string::npos) return {};
  return CLI::detail::split(rest, '|');
}

// Sources that can be opened now.
void offer_found(const acquire::SourceKind& kind, Answer& answer) {
  if (!kind.find) return;
  const auto found = kind.find(open_options());
  if (!found) return;
  for (const acquire::FoundSource& source : *found) answer.offer(source.uri, source.what);
}

// Kinds first; after the colon, the sources of that kind.
void offer_sources(Answer& answer) {
  const std::string& word = answer.word();
  const std::size_t colon = word.find(':');
  for (const acquire::SourceKind& kind : acquire::source_kinds()) {
    const bool is_host = kind.grammar.starts_with(kind.scheme + "://");
    if (colon == std::string::npos) {
      answer.offer(kind.scheme + (is_host ? "://" : ":"), kind.what);
    } else if (word.substr(0, colon) == kind.scheme) {
      const std::vector<std::string> words = choices(kind);
      for (const std::string& choice : words) answer.offer(kind.scheme + ":" + choice, "");
      if (words.empty()) offer_found(kind, answer);
    }
  }
  const std::string replay = "replay:";
  if (word.starts_with(replay)) offer_files("", replay, answer);
}

// `prefix` precedes the value in the same word: "--unit=".
void offer_values(const CLI::Option& option, const std::string& prefix, Answer& answer) {
  const std::vector<std::string> values = listed_values(option);
  const std::string type = option.get_type_name();
  for (const std::string& value : values) answer.offer(prefix + value, "");
  // The file name of an output may have any extension, since it decides the format.
  if (type.starts_with("FILE"))
    offer_files(option.check_lname("output") ? "" : type, prefix, answer);
  else if (values.empty())
    answer.add(":text " + type + ": " + option.get_description());
}

void offer_positional(const CLI::Option& option, Answer& answer) {
  if (option.get_name(true) == "SOURCE")
    offer_sources(answer);
  else if (listed_values(option).empty())
    offer_files("", "", answer);
  else
    offer_values(option, "", answer);
}

bool may_follow(const CLI::Option& option, const Options& given) {
  const bool may_repeat = option.get_expected_max() > 1;
  const auto& excluded = option.get_excludes();
  return std::none_of(given.begin(), given.end(), [&](const CLI::Option* other) {
    if (other == &option) return !may_repeat;
    return std::any_of(excluded.begin(), excluded.end(),
                       [&](const CLI::Option* one) { return one == other; });
  });
}

void offer_flags(const CLI::App& app, const Options& given, Answer& answer) {
  for (const CLI::Option* option : app.get_options()) {
    const bool is_hidden = option->get_group().empty();
    if (option->get_lnames().empty() || is_hidden || !may_follow(*option, given)) continue;
    for (const std::string& name : option->get_lnames())
      answer.offer("--" + name, option->get_description());
  }
}

void offer_verbs(const CLI::App& app, Answer& answer) {
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    answer.offer(verb->get_name(), verb->get_description());
}

// The next positional; the last one may repeat; nullptr: none.
const CLI::Option* next_positional(const Typed& typed) {
  const Options all =
      typed.verb->get_options([](const CLI::Option* option) { return option->get_positional(); });
  std::size_t taken = typed.positionals;
  for (const CLI::Option* option : all) {
    const auto most = static_cast<std::size_t>(option->get_expected_max());
    if (taken < most) return option;
    taken -= most;
  }
  return nullptr;
}

void offer_in_verb(const Typed& typed, Answer& answer) {
  const std::string& word = answer.word();
  const std::size_t equals = word.starts_with("--") ? word.find('=') : std::string::npos;
  if (typed.open != nullptr) return offer_values(*typed.open, "", answer);
  if (equals != std::string::npos) {
    const CLI::Option* option = typed.verb->get_option_no_throw(word.substr(0, equals));
    if (option != nullptr) offer_values(*option, word.substr(0, equals + 1), answer);
    return;
  }
  const CLI::Option* positional = next_positional(typed);
  if (word.starts_with('-') || positional == nullptr)
    offer_flags(*typed.verb, typed.given, answer);
  else
    offer_positional(*positional, answer);
}

}  // namespace

std::string completions(const CLI::App& app, const std::vector<std::string>& words) {
  Answer answer(words.empty() ? "" : words.back());
  const Typed typed = read(app, words);
  if (typed.verb != nullptr)
    offer_in_verb(typed, answer);
  else if (answer.word().starts_with('-'))
    offer_flags(app, {}, answer);
  else
    offer_verbs(app, answer);
  return answer.text();
}

}  // namespace proofmass::app
