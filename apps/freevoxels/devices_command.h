#pragma once
// freevoxels devices

namespace CLI {
class App;
}

namespace freevoxels {

class DevicesCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  bool json_ = false;
};

}  // namespace freevoxels
