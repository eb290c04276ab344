// Calls a fuzzer's entry point without libFuzzer, which only Clang has: replay FOLDER [MIB], for each file in it as it is, and with a
// hundred mutations, the same in every run. Fails where one of them makes the process take more than so many MiB of addresses. The tests
// run it; run.sh looks further.

#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <new>
#include <random>
#include <set>
#include <span>
#include <string>
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

/// Lets allocations beyond so many MiB more than now throw std::bad_alloc, which no reader may answer with an error about its file.
void limitMemory(std::uint64_t mebibytes) {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t bytes = pages * std::uint64_t(sysconf(_SC_PAGESIZE)) + (mebibytes << 20);
  const rlimit limit{bytes, bytes};
  if (setrlimit(RLIMIT_AS, &limit) != 0) std::abort();
}

/// Whether the memory was enough.
bool replay(const std::filesystem::path& file, int mutation, const Bytes& bytes) {
  try {
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    return true;
  } catch (const std::bad_alloc&) {
    std::cerr << file.string() << ": its mutation " << mutation << ", of " << bytes.size() << " bytes, takes too much memory\n";
    return false;
  }
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
  if (argc >= 2)
    for (const auto& entry : std::filesystem::directory_iterator(argv[1])) files.insert(entry.path());
  bool isEnough = true;
  if (argc == 3) {
    isEnough = replay("nothing", 0, {});  // starts threads, which do not count
    limitMemory(std::stoull(argv[2]));
  }
  for (const std::filesystem::path& file : files) {
    const Bytes bytes = readAll(file);
    isEnough = replay(file, 0, bytes) && isEnough;
    for (int i = 1; i <= kMutations; ++i) {
      Bytes mutated = bytes;
      mutate(mutated);
      isEnough = replay(file, i, mutated) && isEnough;
    }
  }
  std::cout << files.size() << " files replayed\n";
  return files.empty() || !isEnough ? 1 : 0;
}
