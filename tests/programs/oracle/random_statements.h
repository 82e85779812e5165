#pragma once
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "tests/programs/oracle/random_expressions.h"

namespace trueshade::testing {

/// A structure that a random program declares.
struct RandomStructure {
  std::string name;
  std::vector<GlslVariable> members;  ///< paths are the members' names
};

/// Writes the statements of functions of random programs.
class RandomStatements {
 public:
  explicit RandomStatements(uint64_t seed) : make_(seed) {}

 protected:
  uint32_t below(uint32_t count) { return make_.random().below(count); }
  double pick(std::initializer_list<double> values) { return values.begin()[below(uint32_t(values.size()))]; }
  std::string name(const char* prefix) { return prefix + std::to_string(++names_); }
  std::string expression(const GlslType& type) { return make_.expression(type, 1 + int(below(uint32_t(depth_)))); }
  void line(const std::string& text) { text_ += std::string(size_t(indent_) * 2, ' ') + text + "\n"; }
  void open(const std::string& text) { line(text.empty() ? "{" : text + " {"), ++indent_; }
  void close(const std::string& after = "") { --indent_, line("}" + after); }

  /// What is declared until this ends is out of scope afterwards.
  struct Block {
    explicit Block(RandomStatements& writer)
        : writer_(writer), size_(writer.make_.scope.size()), structs_(writer.structs_in_scope_) {}
    ~Block() { writer_.make_.scope.resize(size_), writer_.structs_in_scope_ = structs_; }
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    RandomStatements& writer_;
    size_t size_;
    std::vector<std::pair<std::string, size_t>> structs_;
  };

  void declare(const std::string& path, const GlslType& type, bool writable, int elements = 0, bool constant = false) {
    make_.scope.push_back({path, type, elements, writable, constant});
  }

  /// So many, unless the program has become large; with marks between them.
  void statements(uint32_t count, int nesting);
  /// An integer variable of the function's own, for indices.
  void own_integer();
  std::string array_of(const GlslType& type, int elements);
  std::string value_of(const RandomStructure& of);
  void declare_members(const std::string& path, const RandomStructure& of, bool writable);
  /// A scalar of a variable.
  std::string scalar_of(const GlslVariable& variable);
  /// One that was declared lately.
  GlslVariable late_variable();
  /// The bits of a scalar of a variable go into a mark, so that no result is lost on the way to the pixel.
  void mark(const GlslVariable& variable);

  RandomExpressions make_;
  std::string text_;
  int names_ = 0, indent_ = 0, depth_ = 3;
  bool in_loop_ = false, mark_of_file_ = false, marked_ = false;
  GlslType result_{'f', 1, 3};
  std::vector<RandomStructure> structures_;
  std::vector<std::pair<std::string, size_t>> structs_in_scope_;  ///< variables of structures_[second]

 private:
  void statement(int nesting);
  void declaration();
  void assignment();
  /// Functions that return by a parameter as well.
  void two_results();
  /// A call as a statement, with variables for what it writes.
  void call();
  /// A structure of the file's own, a copy of one, or a comparison of two.
  void structured();
  void leaving();
  void branch(int nesting);
  void choice(int nesting);
  /// `break` within leaves the choice, so a loop's is not written there.
  void part_of_choice(int nesting, const std::string& end);
  void loop(int nesting);
};

}  // namespace trueshade::testing
