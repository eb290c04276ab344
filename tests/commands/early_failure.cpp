// Throws what its second argument names while the program is loaded or outside of the handlers of main(), as the first one says.

#include <cerrno>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "engine/core/error.h"

namespace {

using freevoxels::ErrorKind;

void throwNamed(std::string_view kind) {
  if (kind == "bad_alloc") throw std::bad_alloc();
  if (kind == "threads") throw std::system_error(EAGAIN, std::generic_category());
  if (kind == "memory") throw std::system_error(ENOMEM, std::generic_category());
  if (kind == "permission") throw std::system_error(EPERM, std::generic_category());
  if (kind == "error") freevoxels::fail(ErrorKind::Input, "cannot read 'a.vdb'");
  if (kind == "runtime_error") throw std::runtime_error("the name\n'A B' is bad");
  if (kind == "logic_error") throw std::logic_error("");
  if (kind == "int") throw 7;
  if (kind == "terminate") std::terminate();
}

[[gnu::constructor]] void initialise(int count, char** arguments, char**) {
  if (count > 2 && arguments[1] == std::string_view("loading")) throwNamed(arguments[2]);
}

}  // namespace

int main(int count, char** arguments) {
  if (count > 2) throwNamed(arguments[2]);
}
