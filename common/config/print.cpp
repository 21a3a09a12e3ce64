#include <fmt/core.h>

#include <charconv>

#include "voxlist/config/config.h"

namespace voxlist::config {
namespace {

std::string toml_text(bool value) { return value ? "true" : "false"; }

std::string toml_text(int value) { return std::to_string(value); }

// The shortest digits that read back to the same bits; TOML wants a point or an exponent in a
// float.
std::string toml_text(double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  const std::string text(digits, end);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string toml_text(const std::string& value) {
  constexpr char kHex[] = "0123456789ABCDEF";
  std::string text = "\"";
  for (const char c : value) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      text += {'\\', c};
    } else if (code < 0x20 || code == 0x7F) {
      text += {'\\', 'u', '0', '0', kHex[code >> 4], kHex[code & 15]};
    } else {
      text += c;
    }
  }
  return text + '"';
}

template <class T>
std::string toml_text(const std::vector<T>& values) {
  std::string text;
  for (const T& value : values) text += (text.empty() ? "" : ", ") + toml_text(value);
  return "[" + text + "]";
}

template <class T>
std::string range_text(T min, T max) {
  return toml_text(min) + " to " + toml_text(max);
}

// Brings every kind of key down to one call with texts.
class TextVisitor : public SettingsVisitor {
 public:
  void operator()(const char* key, bool& value, const char* doc) override {
    line(key, toml_text(value), doc, "");
  }
  void operator()(const char* key, int& value, const char* doc, int min, int max) override {
    line(key, toml_text(value), doc, range_text(min, max));
  }
  void operator()(const char* key, double& value, const char* doc, double min,
                  double max) override {
    line(key, toml_text(value), doc, range_text(min, max));
  }
  void operator()(const char* key, std::string& value, const char* doc) override {
    line(key, toml_text(value), doc, "");
  }
  void operator()(const char* key, std::vector<double>& value, const char* doc, double min,
                  double max) override {
    line(key, toml_text(value), doc, "each " + range_text(min, max));
  }
  void operator()(const char* key, std::vector<std::string>& value, const char* doc) override {
    line(key, toml_text(value), doc, "");
  }
  void choice(const char* key, std::size_t& chosen, std::span<const char* const> names,
              const char* doc) override {
    line(key, toml_text(std::string(names[chosen])), doc, "");
  }

  std::string text;

 protected:
  virtual void line(const std::string& key, const std::string& value, const std::string& doc,
                    const std::string& range) = 0;
};

class TomlPrinter : public TextVisitor {
 public:
  explicit TomlPrinter(std::string name) : name_(std::move(name)) {}

 private:
  void line(const std::string& key, const std::string& value, const std::string& doc,
            const std::string& range) override {
    text +=
        fmt::format("# {}{}\n{} = {}\n", doc, range.empty() ? "" : " (" + range + ")", key, value);
  }
  void tables(const char* key, const StructList& list, const char* doc) override {
    const std::string name = name_.empty() ? key : fmt::format("{}.{}", name_, key);
    for (std::size_t i = 0; i < list.size; ++i) {
      TomlPrinter printer(name);
      list.visit(i, printer);
      text += fmt::format("\n# {}\n[[{}]]\n{}", doc, name, printer.text);
    }
    if (list.size == 0) text += example(name, list, doc);
  }

  // A table as there might be one.
  static std::string example(const std::string& name, const StructList& list, const char* doc) {
    TomlPrinter printer(name);
    list.visit_default(printer);
    std::string commented = fmt::format("\n# {}\n# [[{}]]\n", doc, name);
    for (const char c : printer.text) {
      if (commented.ends_with('\n')) commented += "# ";
      commented += c;
    }
    return commented;
  }

  const std::string name_;
};

class MarkdownPrinter : public TextVisitor {
  void line(const std::string& key, const std::string& value, const std::string& doc,
            const std::string& range) override {
    text += fmt::format("| `{}{}` | `{}` | {} | {} |\n", prefix_, key, value, range, doc);
  }
  void tables(const char* key, const StructList& list, const char* doc) override {
    text += fmt::format("| `[[{}]]` | none |  | {} |\n", prefix_ + key, doc);
    prefix_ = std::string(key) + '.';
    list.visit_default(*this);
    prefix_.clear();
  }

  std::string prefix_;  // of keys in a list of tables
};

}  // namespace

std::string to_toml(const std::vector<Section>& sections) {
  std::string text;
  for (const Section& section : sections) {
    TomlPrinter printer(section.name);
    section.visit(printer);
    if (section.name.empty())
      text += printer.text;
    else
      text += fmt::format("{}[{}]\n{}", text.empty() ? "" : "\n", section.name, printer.text);
  }
  return text;
}

std::string markdown_table(const Section& section) {
  MarkdownPrinter printer;
  section.visit(printer);
  return "| key | default | range | meaning |\n|---|---|---|---|\n" + printer.text;
}

}  // namespace voxlist::config
