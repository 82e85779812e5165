#pragma once
#include <mpi.h>

#include <deque>
#include <list>
#include <memory>

#include "farm/mpi/mpi_ranks.h"

namespace trueshade {

/// The messages that MPI is sending or receiving. Long ones go in pieces; all pieces but the last have the tag kMore.
class MpiRanks::Traffic {
 public:
  /// Sends and receives among ranks 0 to `ranks` - 1 of the communicator.
  explicit Traffic(MPI_Comm communicator, int ranks) : communicator_(communicator), from_(size_t(ranks)) {}

  /// Starts to send a letter without waiting, and keeps its bytes until they are sent.
  void send(Letter letter);
  /// Continues to send and receive without waiting, and appends each message that has arrived whole to `complete`.
  /// Returns whether anything was sent or received.
  bool advance(std::deque<RankMessage>& complete, const std::deque<Member>& members);
  /// Whether all letters are sent, but for those to forgotten members.
  bool all_sent(const std::deque<Member>& members) const;

 private:
  struct Sent {
    int to;
    std::shared_ptr<const std::vector<uint8_t>> bytes;
    MPI_Request request;
  };
  struct Piece {
    std::vector<uint8_t> bytes;
    bool is_last;
    MPI_Request request;
  };
  struct Source {
    std::deque<Piece> pieces;    // in the order that they were sent in
    std::vector<uint8_t> begun;  // the pieces so far of a message that is not here whole
  };

  bool advance_sent(const std::deque<Member>& members);
  bool accept();
  bool advance_source(int rank, std::deque<RankMessage>& complete);

  MPI_Comm communicator_;
  std::list<Sent> sent_;
  std::vector<Source> from_;
};

}  // namespace trueshade
