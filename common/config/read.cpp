#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

#include "voxlist/config/config.h"
#include "voxlist/config/toml_document.h"

namespace voxlist::config {
namespace {

// What a value of each type is called in a complaint, and how it is taken from a TOML node:
// a whole number may stand for a float, nothing else is converted.
template <class T>
struct Kind;

template <>
struct Kind<bool> {
  static constexpr auto kName = "true or false";
  static std::optional<bool> from(const toml::node& node) { return node.value_exact<bool>(); }
};

template <>
struct Kind<int> {
  static constexpr auto kName = "a whole number of 32 bits";
  static std::optional<int> from(const toml::node& node) {
    const auto value = node.value_exact<std::int64_t>();
    if (!value || !std::in_range<int>(*value)) return std::nullopt;
    return static_cast<int>(*value);
  }
};

template <>
struct Kind<double> {
  static constexpr auto kName = "a number";
  static std::optional<double> from(const toml::node& node) {
    if (const auto whole = node.value_exact<std::int64_t>()) return static_cast<double>(*whole);
    return node.value_exact<double>();
  }
};

template <>
struct Kind<std::string> {
  static constexpr auto kName = "a text in quotes";
  static std::optional<std::string> from(const toml::node& node) {
    return node.value_exact<std::string>();
  }
};

// A double as a stream would print it: six digits.
std::string shown(double value) { return fmt::format("{:g}", value); }
std::string shown(int value) { return fmt::format("{}", value); }

std::string listed(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string one_of(std::span<const char* const> names) {
  std::string text;
  for (const char* name : names) text += (text.empty() ? "" : " or ") + std::string(name);
  return text;
}

// A key with its table, which is none at the root of a file.
std::string full_name(const std::string& table, std::string_view key) {
  return table.empty() ? std::string(key) : fmt::format("{}.{}", table, key);
}

// Takes the keys of one struct from one table.
class Reader : public SettingsVisitor {
 public:
  Reader(const std::filesystem::path& file, const std::string& name, const toml::table& table)
      : file_(file), name_(name), table_(table) {}

  void operator()(const char* key, bool& value, const char*) override { read(key, value); }
  void operator()(const char* key, int& value, const char*, int min, int max) override {
    if (const toml::node* node = read(key, value)) check_range(*node, key, value, min, max);
  }
  void operator()(const char* key, double& value, const char*, double min, double max) override {
    if (const toml::node* node = read(key, value)) check_range(*node, key, value, min, max);
  }
  void operator()(const char* key, std::string& value, const char*) override { read(key, value); }
  void operator()(const char* key, std::vector<double>& values, const char*, double min,
                  double max) override {
    const toml::node* node = read_list(key, values);
    if (!node) return;
    for (const double value : values) check_range(*node, key, value, min, max);
  }
  void operator()(const char* key, std::vector<std::string>& values, const char*) override {
    read_list(key, values);
  }
  void choice(const char* key, std::size_t& chosen, std::span<const char* const> names,
              const char*) override {
    std::string name = names[chosen];
    const toml::node* node = read(key, name);
    if (!node) return;
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
      complain(*node, key, "is \"" + name + "\", must be " + one_of(names));
    else
      chosen = static_cast<std::size_t>(found - names.begin());
  }
  void tables(const char* key, const StructList& list, const char*) override {
    const toml::node* node = find(key);
    if (!node) return;
    const toml::array* array = node->as_array();
    if (!array || !(array->empty() || array->is_homogeneous(toml::node_type::table))) {
      complain(*node, key, fmt::format("must be tables: [[{}]]", full_name(name_, key)));
      return;
    }
    list.resize(array->size());
    for (std::size_t i = 0; i < array->size(); ++i)
      read_table(key, *array->get(i)->as_table(), [&](Reader& reader) { list.visit(i, reader); });
  }

  /// What is wrong with the keys that members asked for.
  const std::vector<std::string>& complaints() const { return complaints_; }

  /// The keys that members asked for.
  const std::set<std::string>& keys() const { return keys_; }

  /// A complaint for each key that no member asked for.
  std::vector<std::string> unknown_keys() const {
    std::vector<std::string> all;
    for (const auto& [key, node] : table_) {
      const std::string text(key.str());
      if (keys_.contains(text)) continue;
      all.push_back(
          complaint(file_, key.source().begin.line,
                    fmt::format("no key {}; known are {}", full_name(name_, text), listed(keys_))));
    }
    return all;
  }

 private:
  // The node that the value was taken from; null if the file does not have it, or has it wrong.
  template <class T>
  const toml::node* read(const char* key, T& value) {
    const toml::node* node = find(key);
    if (!node) return nullptr;
    const auto found = Kind<T>::from(*node);
    if (!found) return complain(*node, key, std::string("must be ") + Kind<T>::kName);
    value = *found;
    return node;
  }

  template <class T>
  const toml::node* read_list(const char* key, std::vector<T>& values) {
    const toml::node* node = find(key);
    if (!node) return nullptr;
    const toml::array* array = node->as_array();
    if (!array) return complain(*node, key, std::string("must be a list, each ") + Kind<T>::kName);
    std::vector<T> found;
    for (const toml::node& element : *array) {
      const auto value = Kind<T>::from(element);
      if (!value) return complain(element, key, std::string("must hold only ") + Kind<T>::kName);
      found.push_back(*value);
    }
    values = std::move(found);
    return node;
  }

  // One of a list of tables; no other program knows more of its keys.
  void read_table(const char* key, const toml::table& table,
                  const std::function<void(Reader&)>& visit) {
    const std::string name = full_name(name_, key);
    Reader reader(file_, name, table);
    visit(reader);
    for (const auto& wrong : {reader.complaints_, reader.unknown_keys()})
      std::ranges::copy(wrong, std::back_inserter(complaints_));
  }

  template <class T>
  void check_range(const toml::node& node, const char* key, T value, T min, T max) {
    if (value >= min && value <= max) return;
    complain(node, key,
             fmt::format("is {}, must be {} to {}", shown(value), shown(min), shown(max)));
  }

  const toml::node* find(const char* key) {
    if (!keys_.insert(key).second) throw std::logic_error(name_ + " names a key twice: " + key);
    return table_.get(key);
  }

  const toml::node* complain(const toml::node& node, const char* key, const std::string& what) {
    complaints_.push_back(complaint(file_, node.source().begin.line,
                                    fmt::format("{} {}", full_name(name_, key), what)));
    return nullptr;
  }

  const std::filesystem::path& file_;
  const std::string& name_;
  const toml::table& table_;
  std::set<std::string> keys_;
  std::vector<std::string> complaints_;
};

// What may stand at the root of a file.
struct Root {
  std::set<std::string> own;    // tables that are read
  std::set<std::string> lists;  // lists of tables that are read, and looked at where they are
  std::set<std::string> other;  // tables of other programs, or lists of them
};

std::string what_is_wrong(const std::string& name, const toml::node& node, const Root& known) {
  if (known.lists.contains(name)) return {};
  const bool is_own = known.own.contains(name);
  if (!is_own && !known.other.contains(name)) {
    std::set<std::string> all = known.own;
    all.insert(known.lists.begin(), known.lists.end());
    all.insert(known.other.begin(), known.other.end());
    return fmt::format("no table [{}]; known are {}", name, listed(all));
  }
  if (node.is_table() || (!is_own && node.is_array_of_tables())) return {};
  return fmt::format("{0} must be a table: [{0}]", name);
}

std::vector<std::string> check_tables(const std::filesystem::path& file, const toml::table& root,
                                      const Root& known) {
  std::vector<std::string> complaints;
  for (const auto& [key, node] : root) {
    const std::string wrong = what_is_wrong(std::string(key.str()), node, known);
    if (!wrong.empty()) complaints.push_back(complaint(file, key.source().begin.line, wrong));
  }
  return complaints;
}

}  // namespace

std::vector<std::string> read_config(const std::filesystem::path& file,
                                     const std::vector<Section>& sections,
                                     const std::vector<std::string>& other_tables) {
  auto [root, complaints] = parse_toml(file);
  Root known{{}, {}, {other_tables.begin(), other_tables.end()}};
  const toml::table nothing;
  for (const Section& section : sections) {
    const bool is_root = section.name.empty();
    const toml::table* table = is_root ? &root : root[section.name].as_table();
    Reader reader(file, section.name, table ? *table : nothing);
    section.visit(reader);
    std::ranges::copy(reader.complaints(), std::back_inserter(complaints));
    if (is_root) {
      known.lists.insert(reader.keys().begin(), reader.keys().end());
      continue;
    }
    known.own.insert(section.name);
    if (!section.shared) std::ranges::copy(reader.unknown_keys(), std::back_inserter(complaints));
  }
  std::ranges::copy(check_tables(file, root, known), std::back_inserter(complaints));
  return complaints;
}

}  // namespace voxlist::config
