// A small stand-in for libFuzzer: mutates the files of a corpus for a while, always in the same order.
//   fuzz_ply [--inputs 300] [--seconds 0] [--seed 1] CORPUS_FOLDER [FOLDER]    or    fuzz_ply FILE   to try one again
// All of the corpus must be read; the second folder holds what once was a finding, which may be refused.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "solver/model/random_stream.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using clerestory::RandomStream;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t below(RandomStream& random, std::size_t n) { return n == 0 ? 0 : random.bits() % n; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Puts a number that programs stumble over in the place of one that is there.
void replace_number(std::string& s, RandomStream& random) {
  constexpr const char* kNumbers[] = {"-1",  "0",         "nan",        "1e999", "-1e-999", "4294967295", "2147483648",
                                      "1e9", "999999999", "0.00000001", "",      "-0",      "1e12",       "255"};
  std::size_t begin = below(random, s.size());
  while (begin < s.size() && !is_digit(s[begin])) ++begin;
  std::size_t end = begin;
  while (end < s.size() && (is_digit(s[end]) || s[end] == '.')) ++end;
  if (begin < end) s.replace(begin, end - begin, kNumbers[below(random, std::size(kNumbers))]);
}

void mutate(std::string& s, const std::vector<std::string>& corpus, RandomStream& random) {
  const std::size_t at = below(random, s.size() + 1);
  const std::size_t some = 1 + below(random, 1 + s.size() / 8);
  switch (below(random, 10)) {
    case 0:
      if (at < s.size()) s[at] = static_cast<char>(s[at] ^ (1 << below(random, 8)));
      break;
    case 1:
      if (at < s.size()) s[at] = static_cast<char>(random.bits());
      break;
    case 2:
      s.erase(at, some);
      break;
    case 3:
      s.insert(at, s.substr(at, some));
      break;
    case 4:
      s.resize(at);
      break;
    case 5:
      s.insert(at, 1 + below(random, 16), static_cast<char>(random.bits()));
      break;
    case 6: {
      const std::string& other = corpus[below(random, corpus.size())];
      s.replace(at, some, other.substr(below(random, other.size() + 1), some));
      break;
    }
    case 7:
      for (std::size_t k = at; k < std::min(at + 4, s.size()); ++k) s[k] = random.bits() % 2 == 0 ? '\xff' : '\0';
      break;
    default:
      replace_number(s, random);
      break;
  }
  if (s.size() > (1 << 16)) s.resize(1 << 16);
}

std::vector<std::string> inputs_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files(std::filesystem::directory_iterator(folder), {});
  std::sort(files.begin(), files.end());
  std::vector<std::string> inputs;
  for (const auto& file : files) inputs.push_back(bytes_of(file));
  return inputs;
}

int run(const std::string& input) {
  return LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
}

}  // namespace

int main(int argc, char** argv) try {
  double seconds = 0;
  std::uint64_t inputs = 300, seed = 1;
  std::vector<std::filesystem::path> from;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--seconds") == 0 && i + 1 < argc) {
      seconds = std::atof(argv[++i]);
    } else if (std::strcmp(argv[i], "--inputs") == 0 && i + 1 < argc) {
      inputs = std::strtoull(argv[++i], nullptr, 10);
    } else if (std::strcmp(argv[i], "--seed") == 0 && i + 1 < argc) {
      seed = std::strtoull(argv[++i], nullptr, 10);
    } else {
      from.emplace_back(argv[i]);
    }
  }
  if (from.empty()) {
    std::fprintf(stderr, "usage: %s [--inputs 300] [--seconds 0] [--seed 1] CORPUS_FOLDER [FOLDER] | FILE\n", argv[0]);
    return 2;
  }
  if (!std::filesystem::is_directory(from.front())) return run(bytes_of(from.front()));

  std::vector<std::string> corpus = inputs_of(from.front());
  for (const std::string& input : corpus) run(input);
  if (corpus.empty() || clerestory::fuzz_tally.refused > 0) {
    std::fprintf(stderr, "%s: the corpus itself must be read without a refusal\n", argv[0]);
    return 1;
  }
  for (std::size_t k = 1; k < from.size(); ++k)
    for (std::string& input : inputs_of(from[k])) {
      run(input);
      corpus.push_back(std::move(input));
    }
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  double slowest = 0;
  for (std::uint64_t n = 0; n < inputs || std::chrono::steady_clock::now() < end; ++n) {
    RandomStream random(seed, n);
    std::string input = corpus[below(random, corpus.size())];
    for (std::size_t k = 1 + below(random, 6); k-- > 0;) mutate(input, corpus, random);
    const auto start = std::chrono::steady_clock::now();
    run(input);
    slowest = std::max(slowest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  const auto& tally = clerestory::fuzz_tally;
  std::printf("%ld read, %ld refused (%ld of them since a library broke down in its child process), slowest %.3f s\n",
              tally.read, tally.refused, tally.broke_down, slowest);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s: not refused as input: %s; the input is in fuzz_work\n", argv[0], error.what());
  return 1;
}
