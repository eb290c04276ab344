// Threads that read the same files at the same time, for the thread sanitizer: threads FOLDER, with what seeds has written there.

#include <atomic>
#include <iostream>
#include <thread>
#include <vector>

#include "engine/core/error.h"
#include "engine/image/image.h"
#include "engine/volume/vdb.h"

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  using namespace freevoxels;
  constexpr int kThreads = 4, kRounds = 20;
  const fs::path folder = argc > 1 ? argv[1] : ".";
  std::atomic<int> read = 0;
  const auto tryTo = [&](const auto& action) {
    try {
      action();
      ++read;
    } catch (const Error&) {  // a file of grids that cannot be drawn
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i)
    threads.emplace_back([&] {
      for (int round = 0; round < kRounds; ++round) {
        for (const auto& file : fs::directory_iterator(folder / "vdb")) {
          tryTo([&] { readVdb(file.path(), "", 1 << 20); });
          tryTo([&] { listVdb(file.path()); });
        }
        for (const char* kind : {"exr", "png"})
          for (const auto& file : fs::directory_iterator(folder / kind)) tryTo([&] { readImage(file.path()); });
      }
    });
  for (std::thread& thread : threads) thread.join();
  std::cout << read << " files read by " << kThreads << " threads\n";
  return read > 0 ? 0 : 1;
}
