#pragma once

#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <stdlib.h>

namespace graftal {

/// While it lives, the C library writes a comma for the decimal point. The locale is compiled into a
/// temporary folder from the Debian package `locales`. A test fails if that cannot be done.
class CommaLocale {
  public:
    CommaLocale() {
        std::string folder = ::testing::TempDir() + "comma_locale_XXXXXX";
        if (!::mkdtemp(folder.data())) return;
        folder_ = folder;
        const std::string made = "localedef --no-archive -i de_DE -f UTF-8 '" + folder + "/de_DE.UTF-8'";
        if (std::system(made.c_str()) != 0) return;
        ::setenv("LOCPATH", folder.c_str(), 1);
        std::setlocale(LC_ALL, "de_DE.UTF-8");
    }
    ~CommaLocale() {
        std::setlocale(LC_ALL, "C");
        ::unsetenv("LOCPATH");
        std::error_code ignored;
        if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
    }
    CommaLocale(const CommaLocale&) = delete;
    CommaLocale& operator=(const CommaLocale&) = delete;

    bool installed() const { return *std::localeconv()->decimal_point == ','; }

  private:
    std::string folder_;
};

} // namespace graftal
