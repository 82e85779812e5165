#include "farm/mpi/traffic.h"

#include <algorithm>
#include <utility>

namespace trueshade {
namespace {

constexpr int kLast = 1, kMore = 2;
constexpr size_t kPiece = size_t(64) << 20;  // far below the 2^31 - 1 that a count of MPI can be

}  // namespace

void MpiRanks::Traffic::send(Letter letter) {
  const auto bytes = std::make_shared<const std::vector<uint8_t>>(std::move(letter.bytes));
  size_t begin = 0;
  do {
    const size_t size = std::min(kPiece, bytes->size() - begin);
    Sent& sent = sent_.emplace_back(Sent{letter.to, bytes, MPI_REQUEST_NULL});
    const int tag = begin + size == bytes->size() ? kLast : kMore;
    MPI_Isend(bytes->data() + begin, int(size), MPI_BYTE, letter.to, tag, communicator_, &sent.request);
    begin += size;
  } while (begin < bytes->size());
}

bool MpiRanks::Traffic::advance(std::deque<RankMessage>& complete, const std::deque<Member>& members) {
  bool moved = advance_sent(members);
  while (accept()) moved = true;
  for (size_t rank = 0; rank < from_.size(); ++rank)
    while (advance_source(int(rank), complete)) moved = true;
  return moved;
}

/// Drops the pieces that have been sent; returns whether there were any. Pieces to a forgotten rank stay.
bool MpiRanks::Traffic::advance_sent(const std::deque<Member>& members) {
  bool moved = false;
  for (auto sent = sent_.begin(); sent != sent_.end();) {
    int done = 0;
    // A request to a rank that is lost never ends: its bytes stay until the process ends.
    if (!members[size_t(sent->to)].forgotten) MPI_Test(&sent->request, &done, MPI_STATUS_IGNORE);
    moved |= done != 0;
    sent = done != 0 ? sent_.erase(sent) : std::next(sent);
  }
  return moved;
}

/// Begins to receive a piece that has been announced, if there is one.
bool MpiRanks::Traffic::accept() {
  int there = 0, size = 0;
  MPI_Message message;
  MPI_Status status;
  if (MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, communicator_, &there, &message, &status) != MPI_SUCCESS || there == 0)
    return false;
  MPI_Get_count(&status, MPI_BYTE, &size);
  Piece& piece = from_[size_t(status.MPI_SOURCE)].pieces.emplace_back(
      Piece{std::vector<uint8_t>(size_t(size)), status.MPI_TAG == kLast, MPI_REQUEST_NULL});
  MPI_Imrecv(piece.bytes.data(), size, MPI_BYTE, &message, &piece.request);
  return true;
}

/// Takes the next piece of a rank's messages, if it has arrived whole, and appends the message to `complete` where the
/// piece is its last. Returns whether a piece had arrived.
bool MpiRanks::Traffic::advance_source(int rank, std::deque<RankMessage>& complete) {
  Source& source = from_[size_t(rank)];
  if (source.pieces.empty()) return false;
  Piece& piece = source.pieces.front();
  int done = 0;
  MPI_Test(&piece.request, &done, MPI_STATUS_IGNORE);
  if (done == 0) return false;
  if (source.begun.empty())
    source.begun = std::move(piece.bytes);
  else
    source.begun.insert(source.begun.end(), piece.bytes.begin(), piece.bytes.end());
  if (piece.is_last) complete.push_back({rank, std::exchange(source.begun, {})});
  source.pieces.pop_front();
  return true;
}

bool MpiRanks::Traffic::all_sent(const std::deque<Member>& members) const {
  return std::all_of(sent_.begin(), sent_.end(),
                     [&members](const Sent& sent) { return members[size_t(sent.to)].forgotten.load(); });
}

}  // namespace trueshade
