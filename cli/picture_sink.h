#pragma once
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "cli/options.h"
#include "core/byte_stream.h"

namespace trueshade {

using EncodedFile = std::vector<std::vector<uint8_t>>;  ///< its bytes, in pieces

/// Where what is made of a picture goes, in the order that it is made in.
class PictureSink {
 public:
  virtual ~PictureSink() = default;
  /// A file of -o. `about`: what is said of it; `is_timed`: its bytes hold times, and differ from run to run.
  virtual void file(const std::string& path, EncodedFile file, const std::string& about, bool is_timed) = 0;
  /// A file of -o that is in its place already.
  virtual void written(const std::string& path, const std::string& about) = 0;
  virtual void video(std::vector<uint8_t> codes) = 0;    ///< of --raw-video
  virtual void text(const std::string& text) = 0;        ///< of --hash, on standard output
  virtual void timed_text(const std::string& text) = 0;  ///< of --stats
  virtual void document(const std::string& json) = 0;    ///< of --json
  virtual void note(const std::string& line) = 0;
};

/// Writes files, and prints the rest: a note with the first picture that calls for it, documents at the end.
class PrintedPictures : public PictureSink {
 public:
  explicit PrintedPictures(const RenderOptions& options) : options_(options) {}
  void file(const std::string& path, EncodedFile file, const std::string& about, bool is_timed) override;
  void written(const std::string& path, const std::string& about) override;
  void video(std::vector<uint8_t> codes) override;
  void text(const std::string& text) override;
  void timed_text(const std::string& text) override;
  void document(const std::string& json) override;
  void note(const std::string& line) override;

  /// With --json prints the document, or of several one with a list of them.
  void end() const;

 private:
  const RenderOptions& options_;
  std::string documents_;  // with commas between
  std::set<std::string> said_;
};

/// Keeps all of it as bytes, which another process can replay().
class PackedPictures : public PictureSink {
 public:
  void file(const std::string& path, EncodedFile file, const std::string& about, bool is_timed) override;
  void written(const std::string& path, const std::string& about) override;
  void video(std::vector<uint8_t> codes) override;
  void text(const std::string& text) override;
  void timed_text(const std::string& text) override;
  void document(const std::string& json) override;
  void note(const std::string& line) override;

  std::vector<uint8_t> bytes() const;

 private:
  void put(bool is_timed, uint8_t kind, const std::string& first, const std::string& second, const EncodedFile& file);

  ByteWriter same_, timed_;  // items with their numbers in the order; the second hold times
  uint64_t items_ = 0;
};

/// The part of PackedPictures::bytes() that is the same wherever it is made; `packed` is such bytes.
std::span<const uint8_t> part_without_times(std::span<const uint8_t> packed);
/// Calls the sink as PackedPictures was called. Error(bad_input) for bytes that PackedPictures has not made.
void replay(std::span<const uint8_t> packed, PictureSink& sink);

}  // namespace trueshade
