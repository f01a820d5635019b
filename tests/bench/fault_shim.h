#pragma once

// What the parts of the fault shim share (fault_shim.cpp). Nothing of it is seen by the program.

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>

#include <dlfcn.h>

#pragma GCC visibility push(hidden)
namespace fault_shim {

enum Kind {
    alloc,
    map,
    open_,
    read_,
    write_,
    sync_,
    seek_,
    close_,
    rename_,
    unlink_,
    mkdir_,
    stat_,
    lock_,
    dup_,
    pipe_,
    fork_,
    exec_,
    wait_,
    poll_,
    thread_,
    load_,
    watch_,
    kinds
};

struct Fault {
    const char* name;
    int error;
};
inline constexpr Fault faults[kinds] = {
    {"alloc", ENOMEM}, {"map", ENOMEM},   {"open", EMFILE}, {"read", EIO},    {"write", ENOSPC},
    {"sync", EIO},     {"seek", EIO},     {"close", EIO},   {"rename", EIO},  {"unlink", EPERM},
    {"mkdir", ENOSPC}, {"stat", EACCES},  {"lock", ENOLCK}, {"dup", EMFILE},  {"pipe", EMFILE},
    {"fork", EAGAIN},  {"exec", ENOMEM},  {"wait", ECHILD}, {"poll", ENOMEM}, {"thread", EAGAIN},
    {"load", ENOMEM},  {"watch", EMFILE},
};

/// What FAULTS_RECORD holds, zeros at first: how many calls were made to fail, and the calls of each
/// kind.
struct Record {
    std::atomic<std::uint64_t> failed;
    struct {
        char name[8];
        std::atomic<std::uint64_t> calls;
    } of[kinds];
};

inline Record* record = nullptr;
inline bool armed = false; ///< from the beginning of main()
inline int failing = -1;
inline std::uint64_t from = 0;
inline bool stays = false;

/// Counts a call; true, with errno, if it shall fail.
inline bool fails(Kind kind) {
    if (!armed) return false;
    const std::uint64_t number = ++record->of[kind].calls;
    if (kind != failing || (stays ? number < from : number != from)) return false;
    ++record->failed;
    errno = faults[kind].error;
    return true;
}

template<typename Function> Function* next(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

template<std::size_t size> struct Name {
    char text[size];
    constexpr Name(const char (&literal)[size]) {
        for (std::size_t i = 0; i < size; ++i)
            text[i] = literal[i];
    }
};

/// Found while this library is loaded: dlsym() waits for the libraries that other threads load, which may be
/// for ever, and a handler of signals must not.
template<Name name, typename Function> inline Function* const found = next<Function>(name.text);

/// Others that are loaded earlier may call it before.
template<Name name, typename Function> Function* next_of() {
    return found<name, Function> ? found<name, Function> : next<Function>(name.text);
}

/// NEXT(open)(path, flags): the function that this one stands before.
#define NEXT(name) (next_of<#name, decltype(::name)>())

/// A stream of stdio on a descriptor, with this library's read(), write(), lseek() and close(): the C
/// library's own streams call theirs by ways that nobody can step in. Null for a negative number.
std::FILE* stream_on(int number, const char* mode);

} // namespace fault_shim
#pragma GCC visibility pop
