// Streams of stdio whose calls to the system the fault shim counts (fault_shim.cpp).

#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <atomic>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

#include "tests/bench/fault_shim.h"

using namespace fault_shim;

namespace {

/// The streams that are made here, with their descriptors.
struct Stream {
    std::atomic<std::FILE*> file = nullptr;
    int number = -1;
};
constexpr int most_streams = 256;
Stream streams[most_streams];

Stream& stream_of(void* cookie) {
    return *static_cast<Stream*>(cookie);
}

ssize_t read_stream(void* cookie, char* bytes, std::size_t count) {
    return ::read(stream_of(cookie).number, bytes, count);
}

ssize_t write_stream(void* cookie, const char* bytes, std::size_t count) {
    const char* at = bytes;
    for (std::size_t left = count; left > 0;) {
        const ssize_t written = ::write(stream_of(cookie).number, at, left);
        if (written < 0) return 0; // as fopencookie() has it
        at += written;
        left -= static_cast<std::size_t>(written);
    }
    return static_cast<ssize_t>(count);
}

int seek_stream(void* cookie, off64_t* offset, int whence) {
    const off64_t place = ::lseek64(stream_of(cookie).number, *offset, whence);
    if (place < 0) return -1;
    *offset = place;
    return 0;
}

int close_stream(void* cookie) {
    Stream& stream = stream_of(cookie);
    const int number = stream.number;
    stream.file = nullptr;
    return ::close(number);
}

int flags_of(const char* mode) {
    const bool both = std::strchr(mode, '+');
    int flags = *mode == 'r' ? (both ? O_RDWR : O_RDONLY) : (both ? O_RDWR : O_WRONLY) | O_CREAT;
    if (*mode == 'w') flags |= O_TRUNC;
    if (*mode == 'a') flags |= O_APPEND;
    if (std::strchr(mode, 'e')) flags |= O_CLOEXEC;
    return flags;
}

} // namespace

std::FILE* fault_shim::stream_on(int number, const char* mode) {
    if (number < 0) return nullptr;
    std::FILE* const taken = reinterpret_cast<std::FILE*>(1);
    for (Stream& stream : streams) {
        std::FILE* none = nullptr;
        if (!stream.file.compare_exchange_strong(none, taken)) continue;
        stream.number = number;
        std::FILE* const file =
            ::fopencookie(&stream, mode, {read_stream, write_stream, seek_stream, close_stream});
        stream.file = file;
        return file;
    }
    ::_exit(125);
}

extern "C" {

std::FILE* fopen(const char* path, const char* mode) {
    const int number = ::open(path, flags_of(mode), 0666);
    std::FILE* const file = stream_on(number, mode);
    if (!file && number >= 0) NEXT(close)(number);
    return file;
}

std::FILE* fopen64(const char* path, const char* mode) {
    return ::fopen(path, mode);
}

std::FILE* fdopen(int number, const char* mode) noexcept {
    return stream_on(number, mode);
}

int fileno(std::FILE* file) noexcept {
    for (const Stream& stream : streams)
        if (stream.file == file) return stream.number;
    return NEXT(fileno)(file);
}

} // extern "C"
