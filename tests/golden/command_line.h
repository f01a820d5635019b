#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/image/image.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {

struct RunResult {
    int status = -1; ///< as a shell has it: 128 + n after signal n
    std::string out;
    std::string err;
};

/// Runs the program `graftal` by a shell in an empty folder of the test's own. Its temporary files go to a
/// folder there too, so that what is left behind is seen.
class CommandLine : public testing::Test {
  protected:
    void SetUp() override;

    /// The arguments are shell text: quotes, redirections and pipes work.
    RunResult graftal(const std::string& arguments) const;
    RunResult shell(const std::string& command) const;

    std::string path(const std::string& name) const { return directory_.path() + "/here/" + name; }
    void write(const std::string& name, const std::string& text) const;
    std::string read(const std::string& name) const;
    bool exists(const std::string& name) const;
    /// A picture, which must be one.
    Image picture(const std::string& name) const;
    /// Draws "render WORDS" by both engines, into native.png and povray.png; how far these differ.
    ImageDifference engines_differ(const std::string& words, double threshold) const;
    /// What follows "graftal" in the commands of a page of docs/, which are set off by four blanks; the
    /// project's scenes/ are made to stand in the working folder.
    std::vector<std::string> commands_of(const std::string& page) const;
    /// The names in the working folder, sorted, separated by blanks.
    std::string files() const;
    /// The same of the folder for temporary files.
    std::string temporary_files() const;

    TemporaryDirectory directory_;
};

/// A path in the project.
std::string source_path(const std::string& name);

/// Models, as words of a shell with a blank behind them, and a size for pictures of them.
inline const std::string gasket = "'" + source_path("scenes/hart/sierpinski.inst") + "' ";
inline const std::string pound_sign = "'" + source_path("scenes/hart/pound_sign.rifs") + "' ";
inline const std::string small = " --size 96x54 --plain-light "; // so that both engines are soon done

} // namespace graftal
