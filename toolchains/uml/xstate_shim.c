// SPDX-License-Identifier: Apache-2.0
/* Preloaded into the user-mode Linux kernel. It hands ptrace a register area of the size that it was built for; a host
 * whose processor has more state (AMX: 11 008 bytes) refuses a short PTRACE_SETREGSET. The area is padded with zeros,
 * which the host takes as initial state. Linux on x86-64 only. */
#define _GNU_SOURCE
#include <elf.h>
#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

static long set_padded(long pid, long kind, const struct iovec* given) {
    static __thread char area[65536] __attribute__((aligned(64)));
    struct iovec padded = {area, sizeof area};
    memset(area, 0, sizeof area);
    memcpy(area, given->iov_base, given->iov_len);
    return syscall(SYS_ptrace, PTRACE_SETREGSET, pid, kind, &padded);
}

long ptrace(enum __ptrace_request request, ...) {
    va_list arguments;
    va_start(arguments, request);
    const long pid = va_arg(arguments, long);
    const long address = va_arg(arguments, long);
    const long data = va_arg(arguments, long);
    va_end(arguments);
    if (request == PTRACE_SETREGSET && address == NT_X86_XSTATE) {
        const struct iovec* given = (const struct iovec*)data;
        if (given->iov_len < 65536) {
            return set_padded(pid, address, given);
        }
    }
    if (request == PTRACE_PEEKTEXT || request == PTRACE_PEEKDATA || request == PTRACE_PEEKUSER) {
        long word = 0;
        const long result = syscall(SYS_ptrace, request, pid, address, &word);
        if (result < 0) {
            return -1;
        }
        errno = 0;
        return word;
    }
    return syscall(SYS_ptrace, request, pid, address, data);
}
