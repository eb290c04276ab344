// Calls a fuzzer's entry point without libFuzzer, which only Clang has: replay FOLDER, for each file in it as it is, and with a
// hundred mutations, the same in every run. The tests run it; run.sh looks further.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <set>
#include <span>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);
/// Null for fuzzers without one of their own.
extern "C" [[gnu::weak]] std::size_t LLVMFuzzerCustomMutator(std::uint8_t* bytes, std::size_t size, std::size_t maximum, unsigned seed);

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes readAll(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(stream), {});
}

std::mt19937 randomBits(1);

std::size_t below(std::size_t count) {
  return std::size_t(randomBits()) % count;
}

/// Some bytes changed, mostly to values at the ends of their range.
void changeBytes(std::span<std::uint8_t> bytes) {
  constexpr std::uint8_t kValues[] = {0x00, 0x01, 0x7f, 0x80, 0xff};
  for (std::size_t i = bytes.empty() ? 0 : below(4) + 1; i > 0; --i) {
    std::uint8_t& byte = bytes[below(bytes.size())];
    byte = below(2) == 0 ? kValues[below(std::size(kValues))] : std::uint8_t(byte ^ (1u << below(8)));
  }
}

void mutate(Bytes& bytes) {
  if (LLVMFuzzerCustomMutator != nullptr && below(4) != 0)
    LLVMFuzzerCustomMutator(bytes.data(), bytes.size(), bytes.size(), unsigned(randomBits()));
  else
    changeBytes(bytes);
  if (below(4) == 0) bytes.resize(below(bytes.size()));
}

}  // namespace

/// What libFuzzer offers to the mutators of its users.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* bytes, std::size_t size, std::size_t) {
  changeBytes({bytes, size});
  return size;
}

int main(int argc, char** argv) {
  constexpr int kMutations = 100;
  std::set<std::filesystem::path> files;  // in an order of their own
  if (argc == 2)
    for (const auto& entry : std::filesystem::directory_iterator(argv[1])) files.insert(entry.path());
  for (const std::filesystem::path& file : files) {
    const Bytes bytes = readAll(file);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    for (int i = 0; i < kMutations; ++i) {
      Bytes mutated = bytes;
      mutate(mutated);
      LLVMFuzzerTestOneInput(mutated.data(), mutated.size());
    }
  }
  std::cout << files.size() << " files replayed\n";
  return files.empty() ? 1 : 0;
}
