// The only file that names nlohmann's parser: its header costs seconds a compilation.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.h"
#include "core/memory_cap.h"
#include "scenes/json/json_value.h"

namespace trueshade::json {
namespace {

/// Builds values from the parser's events. Refusals are thrown from here, where the way to the value is known.
class Builder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(std::string_view text, std::string_view where) : text_(text), where_(where) {}

  Value take() { return std::move(root_); }

  bool null() override { return put(Value{}); }
  bool boolean(bool value) override { return put(Value{value}); }
  bool number_integer(number_integer_t value) override { return put(Value{double(value)}); }
  bool number_unsigned(number_unsigned_t value) override { return put(Value{double(value)}); }
  bool number_float(number_float_t value, const string_t&) override { return put(Value{value}); }
  bool string(string_t& value) override { return put(Value{std::make_unique<std::string>(std::move(value))}); }
  bool binary(binary_t&) override { return false; }  // not in text

  bool start_array(size_t) override { return open(Value{std::make_unique<Array>()}); }
  bool end_array() override { return close(); }
  bool start_object(size_t) override { return open(Value{std::make_unique<Members>()}); }

  bool key(string_t& name) override {
    auto* members = std::get_if<std::unique_ptr<Members>>(&stack_.back()->is);
    (*members)->emplace_back(std::move(name), Value{});
    return true;
  }

  bool end_object() override {
    const Members& members = *std::get<std::unique_ptr<Members>>(stack_.back()->is);
    std::vector<size_t> order(members.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return members[a].first < members[b].first; });
    for (size_t i = 1; i < order.size(); ++i)
      if (members[order[i]].first == members[order[i - 1]].first) {
        std::string pointer = place(stack_.size() - 1);
        append_pointer(pointer, members[order[i]].first);
        refuse(pointer, "this key is given twice", "give it once");
      }
    return close();
  }

  bool parse_error(size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    const std::string_view before = text_.substr(0, position > 0 ? position - 1 : 0);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const size_t start = before.rfind('\n');
    const size_t column = before.size() - (start == std::string_view::npos ? 0 : start + 1) + 1;
    // "[json.exception...] parse error at line 1, column 2: syntax error while parsing value - REASON; last read: ..."
    std::string reason = error.what();
    if (const size_t dash = reason.find(" - "); dash != std::string::npos) reason = reason.substr(dash + 3);
    reason = reason.substr(0, std::min(reason.find("; last read"), size_t(120)));
    if (reason.starts_with("[json.exception.out_of_range"))
      throw Error(ErrorKind::bad_input, place_of(line, column), "a number is too large", "numbers below 1e308");
    for (char& c : reason)
      if (static_cast<unsigned char>(c) < 0x20) c = '?';
    throw Error(ErrorKind::bad_input, place_of(line, column), "this is not JSON: " + reason, "JSON as in RFC 8259");
  }

 private:
  std::string place_of(ptrdiff_t line, size_t column) const {
    return where_ + ": line " + std::to_string(line) + ", column " + std::to_string(column);
  }

  [[noreturn]] void refuse(const std::string& pointer, const std::string& reason, const std::string& remedy) const {
    throw Error(ErrorKind::bad_input, where_ + (pointer.empty() ? "" : ": " + pointer), reason, remedy);
  }

  /// Pointer to the container at `depth` of the stack.
  std::string place(size_t depth) const {
    std::string pointer;
    for (size_t i = 0; i < depth; ++i) {
      if (const auto* array = std::get_if<std::unique_ptr<Array>>(&stack_[i]->is))
        append_pointer(pointer, std::to_string((*array)->size() - 1));
      else
        append_pointer(pointer, std::get<std::unique_ptr<Members>>(stack_[i]->is)->back().first);
    }
    return pointer;
  }

  Value& place_for_next() {
    if (stack_.empty()) return root_;
    if (auto* array = std::get_if<std::unique_ptr<Array>>(&stack_.back()->is)) return (*array)->emplace_back();
    return std::get<std::unique_ptr<Members>>(stack_.back()->is)->back().second;
  }

  bool put(Value&& value) {
    place_for_next() = std::move(value);
    return true;
  }

  bool open(Value&& value) {
    Value& here = place_for_next();
    if (stack_.size() >= size_t(kMaxDepth))
      refuse(place(stack_.size()), "arrays and objects are nested deeper than " + std::to_string(kMaxDepth),
             "nest less");
    here = std::move(value);
    stack_.push_back(&here);
    return true;
  }

  bool close() {
    stack_.pop_back();
    return true;
  }

  std::string_view text_;
  std::string where_;
  Value root_;
  std::vector<Value*> stack_;  // of open containers; an element moves only while its own container is closed
};

/// Bytes that the values of a text take at most while it is read: each stands in a vector, which may be three times as
/// large as its elements while it grows; a key is a string of its own.
uint64_t parsed_bytes(std::string_view text) {
  uint64_t values = 1, keys = 0;
  for (const char c : text) values += c == ',' || c == '[' || c == '{', keys += c == ':';
  return 3 * (values * sizeof(Value) + keys * sizeof(Members::value_type)) + text.size();
}

}  // namespace

Value parse(std::string_view text, std::string_view where) {
  if (text.starts_with("\xEF\xBB\xBF"))
    throw Error(ErrorKind::bad_input, std::string(where) + ": line 1, column 1",
                "the text starts with a byte order mark", "UTF-8 without one");
  require_memory(parsed_bytes(text), where, "its text");
  Builder builder(text, where);
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  return builder.take();
}

}  // namespace trueshade::json
