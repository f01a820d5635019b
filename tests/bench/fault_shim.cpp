// A library to be preloaded: it counts the calls of a program to the system, by kinds, and lets one of them
// fail, or that and all later ones of its kind. tools/bench/faults uses it.
//
//   FAULTS_RECORD=FILE     holds a Record, which outlives every end of the program and its forks
//   FAULTS=KIND:N[:stay]   the N-th call of the kind fails, N from 1; with `stay` all later ones too
//
// It takes part from the beginning of main(). The programs that this one starts are left alone: both
// variables and LD_PRELOAD are gone from the environment before main(). Streams of stdio are made by
// fopencookie(), for the C library's own call read() and write() by ways that nobody can step in.

#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/inotify.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/bench/fault_shim.h"

using namespace fault_shim;

namespace {

void read_settings() {
    const char* path = std::getenv("FAULTS_RECORD");
    if (!path) return;
    const int file = static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC));
    void* const place = reinterpret_cast<void*>(
        ::syscall(SYS_mmap, nullptr, sizeof(Record), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    ::syscall(SYS_close, file);
    if (file < 0 || place == MAP_FAILED) ::_exit(125);
    record = static_cast<Record*>(place);
    for (int kind = 0; kind < kinds; ++kind)
        std::strcpy(record->of[kind].name, faults[kind].name);
    if (const char* fault = std::getenv("FAULTS")) {
        const char* const colon = std::strchr(fault, ':');
        for (int kind = 0; colon && kind < kinds; ++kind)
            if (std::strlen(faults[kind].name) == static_cast<std::size_t>(colon - fault) &&
                std::strncmp(faults[kind].name, fault, static_cast<std::size_t>(colon - fault)) == 0)
                failing = kind;
        if (failing < 0) ::_exit(125);
        char* end = nullptr;
        from = std::strtoull(colon + 1, &end, 10);
        stays = std::strcmp(end, ":stay") == 0;
    }
    ::unsetenv("FAULTS_RECORD");
    ::unsetenv("FAULTS");
    ::unsetenv("LD_PRELOAD");
}

int (*real_main)(int, char**, char**) = nullptr;

int armed_main(int argc, char** argv, char** envp) {
    read_settings();
    if (record) {
        stdout = stream_on(STDOUT_FILENO, "w");
        armed = true;
    }
    return real_main(argc, argv, envp);
}

} // namespace

extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

// Memory

void* malloc(std::size_t size) {
    return fails(alloc) ? nullptr : __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
    return fails(alloc) ? nullptr : __libc_calloc(count, size);
}

void* realloc(void* old, std::size_t size) {
    return fails(alloc) ? nullptr : __libc_realloc(old, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
    return fails(alloc) ? nullptr : __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
    return fails(alloc) ? nullptr : __libc_memalign(alignment, size);
}

int posix_memalign(void** place, std::size_t alignment, std::size_t size) {
    void* const got = fails(alloc) ? nullptr : __libc_memalign(alignment, size);
    if (!got) return ENOMEM;
    *place = got;
    return 0;
}

void* mmap(void* at, std::size_t size, int protection, int flags, int file, off_t offset) {
    return fails(map) ? MAP_FAILED : NEXT(mmap)(at, size, protection, flags, file, offset);
}

void* mmap64(void* at, std::size_t size, int protection, int flags, int file, off64_t offset) {
    return fails(map) ? MAP_FAILED : NEXT(mmap64)(at, size, protection, flags, file, offset);
}

// Descriptors

#define OPEN(name, path, ...)                                                                                \
    mode_t mode = 0;                                                                                         \
    if (flags & (O_CREAT | O_TMPFILE)) {                                                                     \
        va_list more;                                                                                        \
        va_start(more, flags);                                                                               \
        mode = va_arg(more, mode_t);                                                                         \
        va_end(more);                                                                                        \
    }                                                                                                        \
    return fails(open_) ? -1 : NEXT(name)(__VA_ARGS__, mode)

int open(const char* path, int flags, ...) {
    OPEN(open, path, path, flags);
}

int open64(const char* path, int flags, ...) {
    OPEN(open64, path, path, flags);
}

int openat(int folder, const char* path, int flags, ...) {
    OPEN(openat, path, folder, path, flags);
}

int openat64(int folder, const char* path, int flags, ...) {
    OPEN(openat64, path, folder, path, flags);
}

int __open_2(const char* path, int flags) {
    return ::open(path, flags);
}

int __open64_2(const char* path, int flags) {
    return ::open(path, flags);
}

int __openat_2(int folder, const char* path, int flags) {
    return ::openat(folder, path, flags);
}

int __openat64_2(int folder, const char* path, int flags) {
    return ::openat(folder, path, flags);
}

int mkostemp(char* pattern, int flags) {
    return fails(open_) ? -1 : NEXT(mkostemp)(pattern, flags);
}

DIR* opendir(const char* path) {
    return fails(open_) ? nullptr : NEXT(opendir)(path);
}

DIR* fdopendir(int file) {
    return fails(open_) ? nullptr : NEXT(fdopendir)(file);
}

dirent* readdir(DIR* folder) {
    return fails(read_) ? nullptr : NEXT(readdir)(folder);
}

dirent64* readdir64(DIR* folder) {
    return fails(read_) ? nullptr : NEXT(readdir64)(folder);
}

ssize_t read(int file, void* bytes, std::size_t count) {
    return fails(read_) ? -1 : NEXT(read)(file, bytes, count);
}

ssize_t pread(int file, void* bytes, std::size_t count, off_t at) {
    return fails(read_) ? -1 : NEXT(pread)(file, bytes, count, at);
}

ssize_t pread64(int file, void* bytes, std::size_t count, off64_t at) {
    return fails(read_) ? -1 : NEXT(pread64)(file, bytes, count, at);
}

ssize_t write(int file, const void* bytes, std::size_t count) {
    return fails(write_) ? -1 : NEXT(write)(file, bytes, count);
}

int fsync(int file) {
    return fails(sync_) ? -1 : NEXT(fsync)(file);
}

int fdatasync(int file) {
    return fails(sync_) ? -1 : NEXT(fdatasync)(file);
}

off_t lseek(int file, off_t offset, int whence) noexcept {
    return fails(seek_) ? -1 : NEXT(lseek)(file, offset, whence);
}

off64_t lseek64(int file, off64_t offset, int whence) noexcept {
    return fails(seek_) ? -1 : NEXT(lseek64)(file, offset, whence);
}

int close(int file) {
    // As the kernel has it: after a failure the descriptor is gone all the same.
    const bool shall_fail = fails(close_);
    const int reason = errno, result = NEXT(close)(file);
    if (!shall_fail) return result;
    errno = reason;
    return -1;
}

int rename(const char* from_path, const char* to_path) noexcept {
    return fails(rename_) ? -1 : NEXT(rename)(from_path, to_path);
}

int renameat2(int from_folder, const char* from_path, int to_folder, const char* to_path,
              unsigned flags) noexcept {
    return fails(rename_) ? -1 : NEXT(renameat2)(from_folder, from_path, to_folder, to_path, flags);
}

int link(const char* from_path, const char* to_path) noexcept {
    return fails(rename_) ? -1 : NEXT(link)(from_path, to_path);
}

int unlink(const char* path) noexcept {
    return fails(unlink_) ? -1 : NEXT(unlink)(path);
}

int unlinkat(int folder, const char* path, int flags) noexcept {
    return fails(unlink_) ? -1 : NEXT(unlinkat)(folder, path, flags);
}

int remove(const char* path) noexcept {
    return fails(unlink_) ? -1 : NEXT(remove)(path);
}

int rmdir(const char* path) noexcept {
    return fails(unlink_) ? -1 : NEXT(rmdir)(path);
}

int mkdir(const char* path, mode_t mode) noexcept {
    return fails(mkdir_) ? -1 : NEXT(mkdir)(path, mode);
}

char* mkdtemp(char* pattern) noexcept {
    return fails(mkdir_) ? nullptr : NEXT(mkdtemp)(pattern);
}

int stat(const char* path, struct stat* info) noexcept {
    return fails(stat_) ? -1 : next<int(const char*, struct stat*)>("stat")(path, info);
}

int lstat(const char* path, struct stat* info) noexcept {
    return fails(stat_) ? -1 : NEXT(lstat)(path, info);
}

int fstat(int file, struct stat* info) noexcept {
    return fails(stat_) ? -1 : NEXT(fstat)(file, info);
}

int fstatat(int folder, const char* path, struct stat* info, int flags) noexcept {
    return fails(stat_) ? -1 : NEXT(fstatat)(folder, path, info, flags);
}

int access(const char* path, int how) noexcept {
    return fails(stat_) ? -1 : NEXT(access)(path, how);
}

ssize_t readlink(const char* path, char* text, std::size_t size) noexcept {
    return fails(stat_) ? -1 : NEXT(readlink)(path, text, size);
}

char* realpath(const char* path, char* text) noexcept {
    return fails(stat_) ? nullptr : NEXT(realpath)(path, text);
}

int flock(int file, int how) noexcept {
    return fails(lock_) ? -1 : NEXT(flock)(file, how);
}

int futimens(int file, const timespec* times) noexcept {
    return fails(lock_) ? -1 : NEXT(futimens)(file, times);
}

int dup2(int old_file, int new_file) noexcept {
    return fails(dup_) ? -1 : NEXT(dup2)(old_file, new_file);
}

int pipe(int* ends) noexcept {
    return fails(pipe_) ? -1 : NEXT(pipe)(ends);
}

int pipe2(int* ends, int flags) noexcept {
    return fails(pipe_) ? -1 : NEXT(pipe2)(ends, flags);
}

int inotify_init1(int flags) noexcept {
    return fails(watch_) ? -1 : NEXT(inotify_init1)(flags);
}

int inotify_add_watch(int watch, const char* path, std::uint32_t what) noexcept {
    return fails(watch_) ? -1 : NEXT(inotify_add_watch)(watch, path, what);
}

// Processes and threads

pid_t fork() noexcept {
    return fails(fork_) ? -1 : NEXT(fork)();
}

int posix_spawn(pid_t* child, const char* path, const posix_spawn_file_actions_t* actions,
                const posix_spawnattr_t* attributes, char* const* argv, char* const* envp) {
    return fails(fork_) ? EAGAIN : NEXT(posix_spawn)(child, path, actions, attributes, argv, envp);
}

int execve(const char* path, char* const* argv, char* const* envp) noexcept {
    return fails(exec_) ? -1 : NEXT(execve)(path, argv, envp);
}

int waitid(idtype_t what, id_t which, siginfo_t* info, int options) {
    return fails(wait_) ? -1 : NEXT(waitid)(what, which, info, options);
}

pid_t waitpid(pid_t which, int* status, int options) {
    return fails(wait_) ? -1 : NEXT(waitpid)(which, status, options);
}

pid_t wait4(pid_t which, int* status, int options, rusage* usage) noexcept {
    return fails(wait_) ? -1 : NEXT(wait4)(which, status, options, usage);
}

int poll(pollfd* files, nfds_t count, int timeout_ms) {
    return fails(poll_) ? -1 : NEXT(poll)(files, count, timeout_ms);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*),
                   void* argument) noexcept {
    return fails(thread_) ? EAGAIN : NEXT(pthread_create)(thread, attributes, work, argument);
}

void* dlopen(const char* path, int how) noexcept {
    // That there is no such file is what dlerror() says then.
    return NEXT(dlopen)(fails(load_) ? "/a library that fails" : path, how);
}

// The beginning

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*loader_fini)(), void* stack_end) {
    real_main = main;
    return next<decltype(__libc_start_main)>("__libc_start_main")(armed_main, argc, argv, init, fini,
                                                                  loader_fini, stack_end);
}

} // extern "C"
