#include "farm/messages.h"

#include "core/byte_stream.h"

namespace trueshade {
namespace {

constexpr uint32_t kMark = 0x32735254;  // `TRs2`: changed with the form of the messages

}  // namespace

std::vector<uint8_t> packed(const RankSays& says) {
  ByteWriter message;
  message.reserve(64 + says.bytes.size());
  message.number(kMark);
  message.number(uint8_t(says.what));
  message.number(says.round);
  message.number(says.number);
  message.number(says.kind);
  message.number(uint64_t(says.numbers.size()));
  for (const int32_t number : says.numbers) message.number(number);
  message.number(uint64_t(says.words.size()));
  for (const std::string& word : says.words) message.text(word);
  message.run(says.bytes);
  return message.take();
}

std::optional<RankSays> unpacked(std::span<const uint8_t> message) try {
  ByteReader from(message);
  if (from.number<uint32_t>() != kMark) return {};
  RankSays says{};
  says.what = from.enumerator(RankSays::What::bye);
  says.round = from.number<uint32_t>();
  says.number = from.number<int32_t>();
  says.kind = from.number<int32_t>();
  says.numbers.resize(from.count(sizeof(int32_t)));
  for (int32_t& number : says.numbers) number = from.number<int32_t>();
  says.words.resize(from.count(sizeof(uint64_t)));
  for (std::string& word : says.words) word = from.text();
  const std::span<const uint8_t> bytes = from.run();
  says.bytes.assign(bytes.begin(), bytes.end());
  from.end();
  return says;
} catch (const BadBytes&) {
  return {};
}

}  // namespace trueshade
