/* system.h for Windows 7 and later. */
#include "system.h"

#define WIN32_LEAN_AND_MEAN
#define _CRT_RAND_S
#include <windows.h>
/* after windows.h */
#include <errno.h>
#include <process.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

static void set_errno(void) {
    static const struct {
        DWORD code;
        int meaning;
    } rows[] = {{ERROR_FILE_NOT_FOUND, ENOENT},      {ERROR_PATH_NOT_FOUND, ENOENT},
                {ERROR_INVALID_DRIVE, ENOENT},       {ERROR_BAD_NETPATH, ENOENT},
                {ERROR_BAD_NET_NAME, ENOENT},        {ERROR_INVALID_NAME, EINVAL},
                {ERROR_BAD_PATHNAME, EINVAL},        {ERROR_DIRECTORY, ENOTDIR},
                {ERROR_ACCESS_DENIED, EACCES},       {ERROR_SHARING_VIOLATION, EACCES},
                {ERROR_LOCK_VIOLATION, EACCES},      {ERROR_WRITE_PROTECT, EROFS},
                {ERROR_ALREADY_EXISTS, EEXIST},      {ERROR_FILE_EXISTS, EEXIST},
                {ERROR_DISK_FULL, ENOSPC},           {ERROR_HANDLE_DISK_FULL, ENOSPC},
                {ERROR_NOT_ENOUGH_MEMORY, ENOMEM},   {ERROR_OUTOFMEMORY, ENOMEM},
                {ERROR_TOO_MANY_OPEN_FILES, EMFILE}, {ERROR_FILENAME_EXCED_RANGE, ENAMETOOLONG}};
    const DWORD code = GetLastError();
    errno = EIO;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].code == code) errno = rows[i].meaning;
}

static bool succeeded(BOOL ok) {
    if (!ok) set_errno();
    return ok;
}

/* ---- Paths ---- */

/* The full path in UTF-16, to be freed. Long ones get the prefix without which Windows refuses them. */
static wchar_t *wide_path(const char *path) {
    enum { LONG_PATH = 240, PREFIX = 8 }; /* folders end at 248 characters, files at 260 */
    wchar_t *given = NULL, *full = NULL;
    const int length = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, NULL, 0);
    if (length <= 0) {
        errno = EILSEQ;
        return NULL;
    }
    given = malloc((size_t)length * sizeof *given);
    if (given) MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, given, length);
    const DWORD space = given ? GetFullPathNameW(given, 0, NULL, NULL) : 0;
    if (space) full = malloc((space + PREFIX) * sizeof *full);
    if (full) {
        const DWORD got = GetFullPathNameW(given, space, full, NULL);
        const bool share = !wcsncmp(full, L"\\\\", 2),
                   plain = wcsncmp(full, L"\\\\?\\", 4) && wcsncmp(full, L"\\\\.\\", 4);
        if (got >= LONG_PATH && plain) {
            const wchar_t *prefix = share ? L"\\\\?\\UNC" : L"\\\\?\\";
            const size_t before = wcslen(prefix), cut = share ? 1 : 0;
            memmove(full + before, full + cut, (got + 1 - cut) * sizeof *full);
            memcpy(full, prefix, before * sizeof *full);
        }
    } else errno = given && !space ? ENOENT : ENOMEM; /* an empty path has no full one */
    free(given);
    return full;
}

size_t glint_path_folder(const char *path) {
    size_t folder = path[0] && path[1] == ':' ? 2 : 0;
    for (size_t i = 0; path[i]; i++)
        if (path[i] == '/' || path[i] == '\\') folder = i + 1;
    return folder;
}

/* ---- Files ---- */

static glint_file open_wide(const char *path, DWORD access, DWORD share, DWORD creation, DWORD flags) {
    wchar_t *wide = wide_path(path);
    if (!wide) return GLINT_NO_FILE;
    const HANDLE handle = CreateFileW(wide, access, share, NULL, creation, flags, NULL);
    if (handle == INVALID_HANDLE_VALUE) set_errno();
    free(wide);
    return (glint_file)handle;
}

#define SHARE_ALL (FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE)

glint_file glint_file_open(const char *path) {
    /* The flag is what folders need, which describe tells from files. */
    return open_wide(path, GENERIC_READ, SHARE_ALL, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS);
}

glint_file glint_file_open_unlinked(const char *path) {
    const glint_file file = open_wide(path, GENERIC_READ, SHARE_ALL, OPEN_EXISTING,
                                      FILE_FLAG_BACKUP_SEMANTICS | FILE_FLAG_OPEN_REPARSE_POINT);
    BY_HANDLE_FILE_INFORMATION info;
    if (file == GLINT_NO_FILE || !GetFileInformationByHandle((HANDLE)file, &info) ||
        !(info.dwFileAttributes & FILE_ATTRIBUTE_REPARSE_POINT))
        return file;
    CloseHandle((HANDLE)file);
    errno = ELOOP;
    return GLINT_NO_FILE;
}

glint_file glint_file_create(const char *path) {
    return open_wide(path, GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_DELETE, CREATE_ALWAYS, FILE_ATTRIBUTE_NORMAL);
}

/* Nobody may remove it while it is open. The rights of files come from their folder. */
glint_file glint_file_create_temporary(const char *path, bool secret) {
    (void)secret;
    return open_wide(path, GENERIC_WRITE, FILE_SHARE_READ, CREATE_NEW, FILE_ATTRIBUTE_NORMAL);
}

bool glint_file_close(glint_file file) {
    return succeeded(CloseHandle((HANDLE)file));
}

/* Windows renames no file that is open so. */
bool glint_file_close_as(glint_file file, const char *from, const char *to) {
    return glint_file_close(file) && glint_path_replace(from, to);
}

#define MOST_AT_ONCE ((size_t)1 << 30)

bool glint_file_read(glint_file file, void *buffer, size_t size, uint64_t offset, size_t *got) {
    *got = 0;
    while (*got < size) {
        const uint64_t at = offset + *got;
        const size_t left = size - *got;
        OVERLAPPED where = {.Offset = (DWORD)at, .OffsetHigh = (DWORD)(at >> 32)};
        DWORD step = 0;
        if (!ReadFile((HANDLE)file, (char *)buffer + *got, (DWORD)(left < MOST_AT_ONCE ? left : MOST_AT_ONCE), &step,
                      &where)) {
            if (GetLastError() == ERROR_HANDLE_EOF) break;
            return succeeded(FALSE);
        }
        if (step == 0) break;
        *got += step;
    }
    return true;
}

bool glint_file_write(glint_file file, const void *buffer, size_t size, uint64_t offset) {
    for (size_t done = 0; done < size;) {
        const uint64_t at = offset + done;
        const size_t left = size - done;
        OVERLAPPED where = {.Offset = (DWORD)at, .OffsetHigh = (DWORD)(at >> 32)};
        DWORD step = 0;
        if (!WriteFile((HANDLE)file, (const char *)buffer + done, (DWORD)(left < MOST_AT_ONCE ? left : MOST_AT_ONCE),
                       &step, &where))
            return succeeded(FALSE);
        done += step;
    }
    return true;
}

bool glint_file_sync(glint_file file) {
    return succeeded(FlushFileBuffers((HANDLE)file));
}

bool glint_file_describe(glint_file file, struct glint_file_info *info) {
    BY_HANDLE_FILE_INFORMATION found;
    *info = (struct glint_file_info){.kind = GLINT_FILE_OTHER};
    if (GetFileType((HANDLE)file) != FILE_TYPE_DISK) return true; /* NUL, a console, a pipe */
    if (!GetFileInformationByHandle((HANDLE)file, &found)) return succeeded(FALSE);
    const bool folder = found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY;
    info->kind = folder ? GLINT_FILE_FOLDER : GLINT_FILE_REGULAR;
    info->bytes = (uint64_t)found.nFileSizeHigh << 32 | found.nFileSizeLow;
    info->device = found.dwVolumeSerialNumber;
    info->number = (uint64_t)found.nFileIndexHigh << 32 | found.nFileIndexLow;
    return true;
}

bool glint_path_describe(const char *path, struct glint_file_info *info) {
    const glint_file file = open_wide(path, 0, SHARE_ALL, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS);
    if (file == GLINT_NO_FILE) return false;
    const bool ok = glint_file_describe(file, info);
    CloseHandle((HANDLE)file);
    return ok;
}

/* Windows does not rename onto a file that somebody has open, but lets that file be renamed if it was opened so that it may be
   removed, as glint_file_open does. It disappears with its last handle. */
static bool replace_open(const wchar_t *from, const wchar_t *to) {
    const DWORD attributes = GetFileAttributesW(to);
    wchar_t *aside = malloc((wcslen(to) + 32) * sizeof *aside);
    bool ok = false;
    SetLastError(ERROR_ACCESS_DENIED);
    if (!aside || attributes & (FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_READONLY))
        goto done; /* or not there at all */
    wcscpy(aside, to);
    _snwprintf(aside + wcslen(aside), 32, L".old-%lu", GetCurrentProcessId());
    if (!MoveFileExW(to, aside, MOVEFILE_REPLACE_EXISTING)) goto done;
    ok = MoveFileExW(from, to, 0);
    if (ok) DeleteFileW(aside);
    else MoveFileExW(aside, to, 0);
done:
    free(aside);
    return ok;
}

bool glint_path_replace(const char *from, const char *to) {
    wchar_t *source = wide_path(from), *target = source ? wide_path(to) : NULL;
    bool ok = false;
    if (source && target) {
        ok = MoveFileExW(source, target, MOVEFILE_REPLACE_EXISTING);
        if (!ok && (GetLastError() == ERROR_ACCESS_DENIED || GetLastError() == ERROR_SHARING_VIOLATION))
            ok = replace_open(source, target);
        if (!ok) set_errno();
    }
    free(source);
    free(target);
    return ok;
}

bool glint_path_remove(const char *path) {
    wchar_t *wide = wide_path(path);
    const bool ok = wide && succeeded(DeleteFileW(wide));
    free(wide);
    return ok;
}

/* A file that is open cannot be removed. Between closing and renaming it could be, so others leave it alone for an hour. */
static bool is_old(const FILETIME *written) {
    FILETIME now;
    GetSystemTimeAsFileTime(&now);
    const uint64_t hour = (uint64_t)3600 * 10000000,
                   then = (uint64_t)written->dwHighDateTime << 32 | written->dwLowDateTime;
    return ((uint64_t)now.dwHighDateTime << 32 | now.dwLowDateTime) > then + hour;
}

void glint_path_remove_temporaries(const char *path) {
    static const wchar_t tail[] = L"*.tmp-????????";
    wchar_t *wide = wide_path(path), *found = wide ? malloc((wcslen(wide) + MAX_PATH + 32) * sizeof *found) : NULL;
    WIN32_FIND_DATAW entry;
    if (found) {
        const bool all = glint_path_folder(path) == strlen(path);
        wcscpy(found, wide);
        wcscat(found, all ? tail : tail + 1);
        const HANDLE entries = FindFirstFileW(found, &entry);
        wchar_t *name = wcsrchr(wide, L'\\');
        const size_t folder = name ? (size_t)(name - wide) + 1 : 0;
        for (BOOL more = entries != INVALID_HANDLE_VALUE; more; more = FindNextFileW(entries, &entry)) {
            wcscpy(found + folder, entry.cFileName);
            const wchar_t *digits = wcsrchr(entry.cFileName, L'-') + 1;
            if (wcsspn(digits, L"0123456789abcdef") == GLINT_TEMPORARY_DIGITS && is_old(&entry.ftLastWriteTime))
                DeleteFileW(found);
        }
        if (entries != INVALID_HANDLE_VALUE) FindClose(entries);
    }
    free(found);
    free(wide);
}

/* NTFS keeps a journal of names; there is no call for it. */
bool glint_path_sync_folder(const char *path) {
    (void)path;
    return true;
}

bool glint_path_create_folder(const char *path) {
    wchar_t *wide = wide_path(path);
    const bool ok = wide && succeeded(CreateDirectoryW(wide, NULL));
    free(wide);
    return ok;
}

long glint_process_id(void) {
    return (long)GetCurrentProcessId();
}

uint32_t glint_random(void) {
    unsigned number = 0;
    if (rand_s(&number)) number = GetTickCount() * 2654435761U ^ GetCurrentProcessId();
    return number;
}

/* ---- Threads ---- */

static unsigned __stdcall run_thread(void *user) {
    const struct glint_thread *thread = user;
    thread->work(thread->user);
    return 0;
}

bool glint_thread_start(struct glint_thread *thread, void (*work)(void *user), void *user) {
    thread->work = work;
    thread->user = user;
    thread->handle = (void *)_beginthreadex(NULL, 0, run_thread, thread, 0, NULL);
    return thread->handle != NULL;
}

void glint_thread_join(struct glint_thread *thread) {
    WaitForSingleObject(thread->handle, INFINITE);
    CloseHandle(thread->handle);
}

uint32_t glint_cores(void) {
    const DWORD cores = GetActiveProcessorCount(ALL_PROCESSOR_GROUPS);
    return cores < 1 ? 1 : cores;
}

_Static_assert(sizeof(glint_mutex) == sizeof(SRWLOCK), "system.h has them without windows.h");
_Static_assert(sizeof(glint_condition) == sizeof(CONDITION_VARIABLE), "system.h has them without windows.h");

void glint_mutex_init(glint_mutex *mutex) {
    InitializeSRWLock((SRWLOCK *)mutex);
}
void glint_mutex_finish(glint_mutex *mutex) {
    (void)mutex;
}
void glint_mutex_lock(glint_mutex *mutex) {
    AcquireSRWLockExclusive((SRWLOCK *)mutex);
}
void glint_mutex_unlock(glint_mutex *mutex) {
    ReleaseSRWLockExclusive((SRWLOCK *)mutex);
}

void glint_condition_init(glint_condition *condition) {
    InitializeConditionVariable((CONDITION_VARIABLE *)condition);
}
void glint_condition_finish(glint_condition *condition) {
    (void)condition;
}
void glint_condition_wait(glint_condition *condition, glint_mutex *mutex) {
    SleepConditionVariableSRW((CONDITION_VARIABLE *)condition, (SRWLOCK *)mutex, INFINITE, 0);
}
void glint_condition_wake_all(glint_condition *condition) {
    WakeAllConditionVariable((CONDITION_VARIABLE *)condition);
}
