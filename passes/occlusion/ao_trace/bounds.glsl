// Which tiles of 4 x 4 texels nothing can occlude: the boxes of the cells around a tile (ao_bounds) against the tangent plane that its texels
// share. Next include of a pass with the rows of points_rows.h, after points.glsl.
#define TILES
const int TILE = 4;  // texels each way
const int FINEST = 1; // the level of the smallest cells that are looked at
const int VISITS = 96; // cells; a tile that needs more counts as occluded

struct Tile {
    vec3 low, high, normal; // of its surfaces, along the axes of the world; the normal that all of them have
    float lowest;           // of its points along the normal
    float least_m, most_m;  // radii
    bool some, flat_one;    // it has surfaces; all of them have this normal
};

Tile tile_at(ivec2 first) {
    Tile t = Tile(vec3(LARGEST), vec3(-LARGEST), vec3(0.0), LARGEST, LARGEST, 0.0, false, true);
    for (int i = 0; i < TILE * TILE; ++i) {
        ivec2 texel = first + ivec2(i % TILE, i / TILE);
        if (!inside(texel)) continue;
        float depth_m = texelFetch(depth_half, texel, 0).x;
        vec3 shading = texelFetch(normal_half, texel, 0).xyz;
        if (!reflects(depth_m, shading)) continue;
        Receiver r = receiver_at(texel, depth_m, shading);
        vec3 place = mat3(frame.world_from_view) * r.position, normal = normalize(receiver_normal(r.start, shading));
        // The horizons of a surface that is seen edge-on are not about its own normal.
        t.flat_one = t.flat_one && (!t.some || normal == t.normal) && dot(r.normal, normalize(r.position)) < -0.02;
        t.some = true;
        t.normal = normal;
        t.low = min(t.low, place);
        t.high = max(t.high, place);
        t.lowest = min(t.lowest, dot(normal, place));
        t.least_m = min(t.least_m, r.radius_m);
        t.most_m = max(t.most_m, r.radius_m);
    }
    return t;
}

// The texels that show a box, with one more on each side: a texel may hold any of its pixels.
ivec4 texels_of(vec3 low, vec3 high) {
    vec2 from = vec2(LARGEST), to = vec2(-LARGEST), last = vec2(frame.size.zw) - 1.0;
    for (int i = 0; i < 8; ++i) {
        vec3 corner = mat3(frame.view_from_world) * mix(low, high, vec3(i & 1, i >> 1 & 1, i >> 2));
        float depth_m = corner.z * frame.depth_range.z;
        if (!(depth_m > 0.01)) return ivec4(0, 0, last);
        vec2 at = project(corner, frame.uv_from_view, frame.depth_range.z) * vec2(frame.size.zw);
        from = min(from, at);
        to = max(to, at);
    }
    return ivec4(clamp(floor(from) - 1.0, vec2(0.0), last), clamp(floor(to) + 1.0, vec2(0.0), last));
}

// Whether a cell may hold a surface that rises above the tile's tangent planes. nearby: only surfaces within the radius count; false: those in
// front of it, too. low, high: the tile's box with the radius around it.
bool may_rise(Tile t, ivec2 cell, int level, bool nearby, vec3 low, vec3 high) {
    cell = min(cell, max(ivec2(frame.size.zw) >> level, ivec2(1)) - 1); // the last cell of a row is wider
    vec4 from = texelFetch(bounds_low, cell, level), to = texelFetch(bounds_high, cell, level);
    if (from.w == 0.0) return false;
    if (nearby) {
        from.xyz = max(from.xyz, low);
        to.xyz = min(to.xyz, high);
        if (any(greaterThan(from.xyz, to.xyz))) return false;
    }
    vec3 up = max(t.normal * from.xyz, t.normal * to.xyz), most = max(abs(from.xyz), abs(to.xyz));
    float rounding = 4e-6 * (most.x + most.y + most.z + t.most_m);
    return !(up.x + up.y + up.z - t.lowest + rounding <= lift * t.least_m);
}

// Goes down where a cell may rise, and gives up where one of the finest ones does.
bool may_be_occluded(Tile t, bool nearby) {
    if (!t.some || !t.flat_one) return t.some;
    vec3 low = t.low - 1.001 * t.most_m, high = t.high + 1.001 * t.most_m;
    ivec4 texels = texels_of(low, high);
    int top = findMSB(uint(max(texels.z - texels.x, texels.w - texels.y))) + 1; // at most two cells each way
    top = min(top, textureQueryLevels(bounds_low) - 1);
    ivec2 root = texels.xy >> top, cell = root;
    int level = top;
    for (int i = 0; i < VISITS; ++i) {
        bool shown = all(lessThanEqual(cell << level, texels.zw)) && all(greaterThanEqual((cell + 1 << level) - 1, texels.xy));
        if (shown && may_rise(t, cell, level, nearby, low, high)) {
            if (level <= FINEST) return true;
            level--;
            cell *= 2;
            continue;
        }
        while (level < top && (cell & 1) == ivec2(1)) {
            level++;
            cell >>= 1;
        }
        if (level < top) cell += (cell.x & 1) == 0 ? ivec2(1, 0) : ivec2(-1, 1);
        else if (cell.x < texels.z >> top) cell.x++;
        else if (cell.y < texels.w >> top) cell = ivec2(root.x, cell.y + 1);
        else return false;
    }
    return true;
}

bool has_bounds() { return cull && has_bounds_low && has_bounds_high; }

// The first dispatch: one invocation for each tile.
void mark_tile(ivec2 tile, bool nearby) {
    if (any(greaterThanEqual(tile, imageSize(occluded_tiles)))) return;
    bool marked = true;
    if (has_bounds()) marked = may_be_occluded(tile_at(TILE * tile), nearby);
    imageStore(occluded_tiles, tile, uvec4(marked ? 1u : 0u));
}

// The size of the image of tiles is rounded down.
bool is_marked(ivec2 texel) {
    ivec2 tile = texel / TILE, size = textureSize(marked_tiles, 0);
    return any(greaterThanEqual(tile, size)) || texelFetch(marked_tiles, tile, 0).x != 0u;
}
