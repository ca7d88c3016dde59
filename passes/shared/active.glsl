// The active cube maps' centres, w: their fade, in shared memory: every invocation looks at several of them. Call
// load_active_centers() before any invocation returns.
const uint ACTIVE_MOST = 16u;
shared vec4 active_centers[ACTIVE_MOST];

void load_active_centers() {
    if (gl_LocalInvocationIndex < min(frame.counts.x, ACTIVE_MOST))
        active_centers[gl_LocalInvocationIndex] = texelFetch(active_center, ivec2(gl_LocalInvocationIndex, 0), 0);
    barrier();
}
