#pragma once
#include <mpi.h>

#include <deque>
#include <list>
#include <memory>

#include "farm/mpi/mpi_ranks.h"

namespace trueshade {

/// Messages under way. Long ones go in pieces, of which all but the last have the tag kMore.
class MpiRanks::Traffic {
 public:
  /// Messages among `ranks` ranks of the communicator.
  explicit Traffic(MPI_Comm communicator, int ranks) : communicator_(communicator), from_(size_t(ranks)) {}

  /// Begins to send a letter, and keeps its bytes until they are sent. Does not wait.
  void send(Letter letter);
  /// Goes on sending and receiving, without waiting, and appends each message that has arrived whole to `complete`.
  /// Returns whether anything moved.
  bool advance(std::deque<RankMessage>& complete, const std::deque<Member>& members);
  /// Whether nothing is left to be sent but to members that are forgotten.
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
