#pragma once

#include <fstream>
#include <string>
#include <string_view>

#include "compiler/support/check.h"
#include "runtime/system/temporary_directory.h"

namespace graftal::fuzz {

/// A folder for the files that a fuzzer must read, under TMPDIR. It goes with the process.
class Scratch {
  public:
    Scratch() { GRAFTAL_CHECK(directory_.create().ok(), "fuzzer: no temporary folder"); }

    std::string path(std::string_view name) const { return directory_.path() + "/" + std::string(name); }
    void write(std::string_view name, std::string_view bytes) const {
        std::ofstream file(path(name), std::ios::binary | std::ios::trunc);
        file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        GRAFTAL_CHECK(file.flush().good(), "fuzzer: cannot write a temporary file");
    }

  private:
    TemporaryDirectory directory_;
};

} // namespace graftal::fuzz
