#include "runtime/studio/files/stored.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace graftal {
namespace {

TEST(Stored, ZlibReadsItBack) {
    for (const std::size_t size : {0, 1, 5552, 5553, 65535, 65536, 200000}) {
        std::string bytes(size, '\0');
        for (std::size_t i = 0; i < size; ++i)
            bytes[i] = static_cast<char>(255 - i * i % 251);
        const std::string packed = stored(bytes);
        std::string read(size + 1, '\0');
        uLongf read_size = read.size();
        EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(read.data()), &read_size,
                             reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
                  Z_OK);
        read.resize(read_size);
        EXPECT_EQ(read, bytes);
    }
}

} // namespace
} // namespace graftal
