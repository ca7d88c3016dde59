/* compile_script FILE.js OUTPUT: writes Duktape's bytecode of a script at build time, since compiling ECharts takes ten times as long as loading that. */
#include <duktape.h>
#include <stdio.h>
#include <stdlib.h>

static duk_ret_t compile(duk_context *js, void *user) {
    char **paths = user;
    FILE *from = fopen(paths[1], "rb"), *to = fopen(paths[2], "wb");
    if (!from || !to || fseek(from, 0, SEEK_END) != 0)
        return duk_error(js, DUK_ERR_ERROR, "cannot open %s or %s", paths[1], paths[2]);
    const long length = ftell(from);
    rewind(from);
    char *text = length < 0 ? NULL : malloc((size_t)length + 1);
    if (!text || fread(text, 1, (size_t)length, from) != (size_t)length)
        return duk_error(js, DUK_ERR_ERROR, "cannot read %s", paths[1]);
    duk_push_string(js, "echarts.min.js");
    duk_compile_lstring_filename(js, 0, text, (size_t)length);
    duk_dump_function(js);
    size_t size;
    const void *code = duk_require_buffer_data(js, -1, &size);
    if (fwrite(code, 1, size, to) != size || fclose(to) != 0)
        return duk_error(js, DUK_ERR_ERROR, "cannot write %s", paths[2]);
    fclose(from);
    free(text);
    return 0;
}

int main(int argc, char **argv) {
    duk_context *js = argc == 3 ? duk_create_heap_default() : NULL;
    const int failed = !js || duk_safe_call(js, compile, argv, 0, 1) != DUK_EXEC_SUCCESS;
    if (failed) fprintf(stderr, "compile_script: %s\n", js ? duk_safe_to_string(js, -1) : "expected FILE.js OUTPUT");
    duk_destroy_heap(js);
    return failed;
}
