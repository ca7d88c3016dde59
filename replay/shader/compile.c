/* Compiles GLSL with glslang, in a process of its own. A shader may come from anybody: macros that expand without end, expressions nested so deeply that
   the compiler's stack overflows, or a fault of the compiler then end that process, within limits of time and memory, and not the caller's. */
#define _GNU_SOURCE /* pipe2 */
#include "clamp.h"
#include "compile.h"
#include "start.h"
#include "words.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>

/* Several times what the largest shader of passes/ takes. */
enum { CPU_SECONDS = 20, WALL_SECONDS = 20 * CPU_SECONDS, MEMORY_MIB = 256, SPIRV_MIB = 1 };

/* Joins glslang's log, which has one message a line, into one error message. Messages of the linker do not name a file. */
static bool fail_with_log(const char *path, bool names_file, const char *log, struct glint_error *err) {
    char text[800] = "", line[512];
    size_t used = 0;
    while (*log) {
        size_t length = strcspn(log, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, log);
        log += length + (log[length] == '\n');
        /* Skips summaries such as "compilation terminated" and "2 compilation errors". */
        if (strncmp(line, "ERROR: ", 7) != 0 || strstr(line, "compilation terminated") ||
            strstr(line, "No code generated"))
            continue;
        if (used + strlen(line) < sizeof text) used += (size_t)sprintf(text + used, "%s%s", used ? "; " : "", line + 7);
    }
    const bool prefix = !names_file || !used;
    return glint_fail(err, GLINT_ERROR_FORMAT, "%s%s%s", prefix ? path : "", prefix ? ": " : "",
                      used ? text : "does not compile");
}

static glslang_input_t input_of(const char *code) {
    return (glslang_input_t){.language = GLSLANG_SOURCE_GLSL,
                             .stage = GLSLANG_STAGE_COMPUTE,
                             .client = GLSLANG_CLIENT_VULKAN,
                             .client_version = GLSLANG_TARGET_VULKAN_1_3,
                             .target_language = GLSLANG_TARGET_SPV,
                             .target_language_version = GLSLANG_TARGET_SPV_1_6,
                             .code = code,
                             .default_version = 460,
                             .default_profile = GLSLANG_CORE_PROFILE,
                             .messages = GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT,
                             .resource = glslang_default_resource()};
}

static bool compile_text(struct compiled_text *out, const char *path, const char *code, struct glint_error *err) {
    const glslang_input_t input = input_of(code);
    glslang_shader_t *shader = glslang_shader_create(&input);
    glslang_program_t *program = glslang_program_create();
    bool ok = false;
    if (!shader || !program) glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    else if (!glslang_shader_preprocess(shader, &input) || !glslang_shader_parse(shader, &input))
        fail_with_log(path, true, glslang_shader_get_info_log(shader), err);
    else {
        glslang_program_add_shader(program, shader);
        if (!glslang_program_link(program, (int)input.messages))
            fail_with_log(path, false, glslang_program_get_info_log(program), err);
        else {
            glslang_program_SPIRV_generate(program, input.stage);
            out->bytes = glslang_program_SPIRV_get_size(program) * sizeof(uint32_t);
            out->words = out->bytes ? malloc(out->bytes) : NULL;
            if (out->words) glslang_program_SPIRV_get(program, out->words);
            ok = out->words || glint_fail(err, GLINT_ERROR_MEMORY, "%s: no SPIR-V was generated", path);
        }
    }
    if (program) glslang_program_delete(program);
    if (shader) glslang_shader_delete(shader);
    return ok;
}

/* Mesa unrolls a loop that asks for it, however often it turns, and then lacks the memory. */
static void forget_unrolling(const struct compiled_text *compiled) {
    enum { UNROLL = 1 };
    const size_t count = compiled->bytes / sizeof *compiled->words;
    for (size_t at = HEADER, length; at < count; at += length) {
        uint32_t *op = compiled->words + at;
        if ((length = op_words(op)) == 0) break;
        if (opcode(op) == OP_LOOP_MERGE && length > 3) op[3] &= ~(uint32_t)UNROLL;
    }
}

/* Replaces the module by one that cannot harm the process that runs it. */
static bool make_harmless(struct compiled_text *compiled, const char *path, struct glint_error *err) {
    size_t bytes;
    forget_unrolling(compiled);
    uint32_t *words = spirv_clamp(compiled->words, compiled->bytes, &bytes);
    if (!words) return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "%s: its indices into arrays cannot be checked", path);
    free(compiled->words);
    *compiled = (struct compiled_text){words, bytes};
    return true;
}

/* ---- The process that compiles ---- */

/* What it writes, followed by the error's message or the SPIR-V. */
struct answer {
    uint32_t code; /* enum glint_code */
    uint32_t bytes;
};

static void write_all(int file, const void *data, size_t bytes) {
    for (const char *at = data; bytes > 0;) {
        const ssize_t written = write(file, at, bytes);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) _exit(1); /* nobody reads */
        at += written;
        bytes -= (size_t)written;
    }
}

/* The address space of the caller, which the new process has, too, in bytes; 0: unknown. */
static rlim_t space_in_use(void) {
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (!file) return 0;
    if (fscanf(file, "%lu", &pages) != 1) pages = 0;
    fclose(file);
    return (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

static void set_limits(rlim_t in_use) {
    static const int signals[] = {SIGXCPU, SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGPIPE};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) signal(signals[i], SIG_DFL);
    const struct rlimit cpu = {CPU_SECONDS, CPU_SECONDS + 1}, none = {0, 0};
    const struct rlimit memory = {in_use + ((rlim_t)MEMORY_MIB << 20), in_use + ((rlim_t)MEMORY_MIB << 20)};
    setrlimit(RLIMIT_CPU, &cpu);
    setrlimit(RLIMIT_CORE, &none);
    if (in_use) setrlimit(RLIMIT_AS, &memory);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0) dup2(nowhere, STDERR_FILENO); /* what the C++ runtime says of an exception */
}

static void compile_and_exit(int out, rlim_t in_use, const char *path, const char *code, bool clamp) {
    struct compiled_text compiled = {0};
    struct glint_error err = {0};
    set_limits(in_use);
    const bool ok = compile_text(&compiled, path, code, &err) && (!clamp || make_harmless(&compiled, path, &err));
    const size_t bytes = ok ? compiled.bytes : strlen(err.message);
    const struct answer answer = {ok ? GLINT_OK : err.code, (uint32_t)bytes};
    write_all(out, &answer, sizeof answer);
    write_all(out, ok ? (const void *)compiled.words : err.message, bytes);
    _exit(0);
}

/* ---- The caller's side ---- */

/* Reads `bytes`; false at the end of the file or of the time. */
static bool read_all(int file, void *data, size_t bytes, double until) {
    for (char *at = data; bytes > 0;) {
        struct pollfd ready = {.fd = file, .events = POLLIN};
        const double left = until - glint_now_seconds();
        const int found = left > 0 ? poll(&ready, 1, (int)(1e3 * left) + 1) : 0;
        const ssize_t got = found > 0 ? read(file, at, bytes) : found;
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        at += got;
        bytes -= (size_t)got;
    }
    return true;
}

/* Ends the process, of which `status` receives how it ended; 0 also where the caller's program collects all of its processes by itself. */
static void end_process(pid_t process, bool by_force, int *status) {
    if (by_force) kill(process, SIGKILL);
    *status = 0;
    while (waitpid(process, status, 0) < 0 && errno == EINTR) continue;
}

static bool fail_ended(const char *path, bool timed_out, int status, struct glint_error *err) {
    const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (timed_out || number == SIGXCPU || number == SIGKILL)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s: compiling it takes more than %d s, the limit", path,
                          CPU_SECONDS);
    return glint_fail(err, GLINT_ERROR_LIMIT,
                      "%s: compiling it needs more than %d MiB of memory, the limit, or makes the compiler crash%s%s",
                      path, MEMORY_MIB, number ? ": " : "", number ? strsignal(number) : "");
}

/* False without an error if the process ended, or the time did, before it was read. */
static bool read_answer(struct compiled_text *out, int from, double until, const char *path, struct glint_error *err) {
    struct answer answer;
    char message[sizeof err->message] = "";
    if (!read_all(from, &answer, sizeof answer, until)) return false;
    if (answer.code != GLINT_OK)
        return answer.bytes < sizeof message && read_all(from, message, answer.bytes, until) &&
               glint_fail(err, (enum glint_code)answer.code, "%s", message);
    if (answer.bytes > SPIRV_MIB << 20)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s: compiled it has %u bytes, more than %d MiB, the limit", path,
                          answer.bytes, SPIRV_MIB);
    out->bytes = answer.bytes;
    if (!(out->words = malloc(answer.bytes))) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    return read_all(from, out->words, answer.bytes, until);
}

static bool compile_apart(struct compiled_text *out, const char *path, const char *code, bool clamp,
                          struct glint_error *err) {
    int ends[2], status;
    struct glint_error own = {0};
    if (pipe2(ends, O_CLOEXEC) != 0)
        return glint_fail(err, GLINT_ERROR_IO, "%s: the compiler cannot start: %s", path, strerror(errno));
    const rlim_t in_use = space_in_use();
    const double until = glint_now_seconds() + WALL_SECONDS;
    const pid_t process = fork();
    if (process == 0) {
        close(ends[0]);
        compile_and_exit(ends[1], in_use, path, code, clamp);
    }
    const int error = errno;
    close(ends[1]);
    const bool ok = process > 0 && read_answer(out, ends[0], until, path, &own);
    const bool timed_out = glint_now_seconds() >= until;
    close(ends[0]);
    if (process < 0) return glint_fail(err, GLINT_ERROR_IO, "%s: the compiler cannot start: %s", path, strerror(error));
    end_process(process, timed_out || own.code == GLINT_ERROR_LIMIT, &status);
    if (ok) return true;
    free(out->words);
    *out = (struct compiled_text){0};
    return own.code ? glint_fail(err, own.code, "%s", own.message) : fail_ended(path, timed_out, status, err);
}

/* Initialising and finalising glslang is global to the process, counted, and not thread-safe. The first compilation after it parses GLSL's built-in
   functions, which takes longer than most shaders: so it is made here, where it is kept as long as the device, and where each process that compiles
   finds it. */
static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;

static bool start_compiler(bool *started, const char *path, struct glint_error *err) {
    static bool broken;
    if (*started) return true;
    const glslang_input_t empty = input_of("#version 460\nvoid main() {}\n");
    if (!broken) broken = !(*started = start_glslang(&empty));
    return *started || glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory: glslang cannot start", path);
}

bool compile_glsl(struct compiled_text *out, bool *started, const char *path, const char *code, bool clamp,
                  struct glint_error *err) {
    pthread_mutex_lock(&one_at_a_time);
    const bool ok = start_compiler(started, path, err) && compile_apart(out, path, code, clamp, err);
    pthread_mutex_unlock(&one_at_a_time);
    return ok;
}

void compile_end(bool *started) {
    pthread_mutex_lock(&one_at_a_time);
    if (*started) glslang_finalize_process();
    pthread_mutex_unlock(&one_at_a_time);
    *started = false;
}
