#include "farm/messages.h"

#include <cstring>

namespace trueshade {
namespace {

template <class Number>
void put(std::vector<uint8_t>& to, Number number) {
  const auto* const bytes = reinterpret_cast<const uint8_t*>(&number);  // all ranks are of one byte order
  to.insert(to.end(), bytes, bytes + sizeof number);
}

class Unpacking {
 public:
  explicit Unpacking(std::span<const uint8_t> rest) : rest_(rest) {}

  template <class Number>
  bool get(Number& number) {
    if (rest_.size() < sizeof number) return false;
    std::memcpy(&number, rest_.data(), sizeof number);
    rest_ = rest_.subspan(sizeof number);
    return true;
  }
  bool get(std::string& word) {
    uint32_t size = 0;
    if (!get(size) || rest_.size() < size) return false;
    word.assign(reinterpret_cast<const char*>(rest_.data()), size);
    rest_ = rest_.subspan(size);
    return true;
  }
  template <class Element>
  bool get(std::vector<Element>& list) {
    uint32_t count = 0;
    if (!get(count) || rest_.size() < count) return false;  // an element has one byte or more
    list.resize(count);
    for (Element& element : list)
      if (!get(element)) return false;
    return true;
  }
  std::span<const uint8_t> rest() const { return rest_; }

 private:
  std::span<const uint8_t> rest_;
};

constexpr uint32_t kMark = 0x31735254;  // `TRs1`: changed with the form of the messages

}  // namespace

std::vector<uint8_t> packed(const RankSays& says) {
  std::vector<uint8_t> message;
  message.reserve(64 + says.bytes.size());
  put(message, kMark);
  put(message, uint8_t(says.what));
  put(message, says.round);
  put(message, says.number);
  put(message, says.kind);
  put(message, uint32_t(says.numbers.size()));
  for (const int32_t number : says.numbers) put(message, number);
  put(message, uint32_t(says.words.size()));
  for (const std::string& word : says.words) {
    put(message, uint32_t(word.size()));
    message.insert(message.end(), word.begin(), word.end());
  }
  message.insert(message.end(), says.bytes.begin(), says.bytes.end());
  return message;
}

std::optional<RankSays> unpacked(std::span<const uint8_t> message) {
  Unpacking from(message);
  RankSays says{};
  uint32_t mark = 0;
  uint8_t what = 0;
  if (!from.get(mark) || mark != kMark || !from.get(what) || what > uint8_t(RankSays::What::bye)) return {};
  says.what = RankSays::What(what);
  if (!from.get(says.round) || !from.get(says.number) || !from.get(says.kind) || !from.get(says.numbers) ||
      !from.get(says.words))
    return {};
  says.bytes.assign(from.rest().begin(), from.rest().end());
  return says;
}

}  // namespace trueshade
