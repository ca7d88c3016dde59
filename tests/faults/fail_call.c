/* System calls that fail. A filter (seccomp) hands those of the kind that was asked for to a signal handler, which lets them fail or makes
   them itself: so what libc makes inside, such as the writes of fflush, comes here as well. The filter lets calls from `make_call` through.
   */
#include "fail.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

/* The system call of this number, with its result as the kernel returns it. */
long fail_make_call(long call, long a, long b, long c, long d, long e, long f);
extern const char fail_call_made[]; /* where it returns to */
__asm__(
    ".text\n"
    ".globl fail_make_call\n.hidden fail_make_call\n.type fail_make_call, @function\n"
    ".globl fail_call_made\n.hidden fail_call_made\n"
    "fail_make_call:\n"
    "mov %rdi, %rax\nmov %rsi, %rdi\nmov %rdx, %rsi\nmov %rcx, %rdx\nmov %r8, %r10\nmov %r9, %r8\nmov 8(%rsp), %r9\n"
    "syscall\n"
    "fail_call_made:\n"
    "ret\n"
    ".size fail_make_call, .-fail_make_call\n");

static const struct call {
    long number;
    enum fail_kind kind;
    int error; /* what it usually fails with */
    int bytes; /* which argument is the number of bytes, from 0, or -1 */
} calls[] = {
    {SYS_read, FAIL_READ, EIO, 2},           {SYS_pread64, FAIL_READ, EIO, 2},
    {SYS_readv, FAIL_READ, EIO, -1},         {SYS_write, FAIL_WRITE, ENOSPC, 2},
    {SYS_pwrite64, FAIL_WRITE, ENOSPC, 2},   {SYS_writev, FAIL_WRITE, ENOSPC, -1},
    {SYS_ftruncate, FAIL_WRITE, ENOSPC, -1}, {SYS_open, FAIL_OPEN, EMFILE, -1},
    {SYS_openat, FAIL_OPEN, EMFILE, -1},     {SYS_rename, FAIL_RENAME, EIO, -1},
    {SYS_renameat, FAIL_RENAME, EIO, -1},    {SYS_renameat2, FAIL_RENAME, EIO, -1},
    {SYS_link, FAIL_RENAME, EIO, -1},        {SYS_linkat, FAIL_RENAME, EIO, -1},
    {SYS_fsync, FAIL_SYNC, EIO, -1},         {SYS_fdatasync, FAIL_SYNC, EIO, -1},
    {SYS_mmap, FAIL_MMAP, ENOMEM, -1},       {SYS_mkdir, FAIL_MAKE, ENOSPC, -1},
    {SYS_mkdirat, FAIL_MAKE, ENOSPC, -1},    {SYS_unlink, FAIL_REMOVE, EIO, -1},
    {SYS_unlinkat, FAIL_REMOVE, EIO, -1},    {SYS_rmdir, FAIL_REMOVE, EIO, -1},
};
enum { CALLS = sizeof calls / sizeof *calls };

/* A system call that the filter lets through. */
static long make(long call, long a, long b, long c, long d) {
    return fail_make_call(call, a, b, c, d, 0, 0);
}

/* In one write of a whole line, before the call: what was synced is on the disk when the next line is written. */
static void write_log(const struct call *call, const long a[6]) {
    char line[9000], target[4096] = "", link[64];
    struct stat found;
    int length = 0;
    if (call->kind == FAIL_SYNC) {
        snprintf(link, sizeof link, "/proc/self/fd/%ld", a[0]);
        const ssize_t got = readlink(link, target, sizeof target - 1);
        length = snprintf(line, sizeof line, "sync %.*s\n", got > 0 ? (int)got : 0, target);
    } else if (call->kind == FAIL_RENAME) {
        const bool at = call->number != SYS_rename && call->number != SYS_link;
        const char *from = (const char *)(at ? a[1] : a[0]), *to = (const char *)(at ? a[3] : a[1]);
        const bool over = lstat(to, &found) == 0;
        length = snprintf(line, sizeof line, "%s %.4000s %.4000s\n", over ? "over" : "rename", from, to);
    }
    const long file =
        length ? make(SYS_openat, AT_FDCWD, (long)fail_log(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600) : -1;
    if (file < 0) return;
    make(SYS_write, file, (long)line, length, 0);
    make(SYS_close, file, 0, 0, 0);
}

/* A signal that is blocked cannot be caught, and the process would end: threads of a server block all of them. */
int pthread_sigmask(int how, const sigset_t *set, sigset_t *before) {
    static int (*next)(int, const sigset_t *, sigset_t *);
    if (!next) *(void **)&next = dlsym(RTLD_NEXT, "pthread_sigmask");
    sigset_t most;
    if (set) {
        most = *set;
        if (how != SIG_UNBLOCK) sigdelset(&most, SIGSYS);
    }
    return next(how, set ? &most : NULL, before);
}

static void handle(int signal, siginfo_t *info, void *user) {
    (void)signal;
    const int before = errno;
    greg_t *r = ((ucontext_t *)user)->uc_mcontext.gregs;
    long a[6] = {r[REG_RDI], r[REG_RSI], r[REG_RDX], r[REG_R10], r[REG_R8], r[REG_R9]};
    const struct call *call = calls;
    while (call < calls + CALLS - 1 && call->number != info->si_syscall) call++;
    /* Where all fail, as on a full disk, there still is a terminal for messages. */
    const bool terminal = fail_all() && call->kind == FAIL_WRITE && a[0] == STDERR_FILENO;
    const bool fails = !terminal && fail_now(call->kind, fail_site(NULL));
    if (fails && fail_kills()) kill(getpid(), SIGKILL);
    if (fail_log()) write_log(call, a);
    if (fails && fail_short() && call->bytes >= 0) a[call->bytes] = (a[call->bytes] + 1) / 2;
    if (fails && !fail_short()) r[REG_RAX] = -fail_error(call->error);
    else r[REG_RAX] = fail_make_call(info->si_syscall, a[0], a[1], a[2], a[3], a[4], a[5]);
    if (fails && fail_tears()) kill(getpid(), SIGKILL);
    errno = before;
}

void fail_catch_calls(void) {
    struct sock_filter filter[8 + CALLS] = {0};
    const uintptr_t made = (uintptr_t)fail_call_made;
    unsigned short n = 0;
    unsigned char wanted = 0;
    for (int i = 0; i < CALLS; i++) wanted += fail_watches(calls[i].kind);
    if (!wanted) return;
    const unsigned low = offsetof(struct seccomp_data, instruction_pointer);
    filter[n++] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, low);
    filter[n++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)made, 0, 2);
    filter[n++] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, low + 4);
    filter[n++] =
        (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)(made >> 32), (unsigned char)(wanted + 1), 0);
    filter[n++] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
    unsigned char left = wanted;
    for (int i = 0; i < CALLS; i++) {
        if (!fail_watches(calls[i].kind)) continue;
        filter[n++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)calls[i].number, left, 0);
        left--;
    }
    filter[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    filter[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
    struct sigaction action = {.sa_sigaction = handle, .sa_flags = SA_SIGINFO | SA_NODEFER};
    sigemptyset(&action.sa_mask);
    const struct sock_fprog program = {n, filter};
    if (sigaction(SIGSYS, &action, NULL) || prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) ||
        syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &program)) {
        static const char text[] = "glint_fail: this system has no filters of system calls\n";
        if (write(2, text, sizeof text - 1)) _exit(99);
    }
}
