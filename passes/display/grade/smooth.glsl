// T. Lottes, FXAA, NVIDIA 2009, from its published description: an edge between pixels runs along rows or columns, and where it steps to the
// next one, pixels are blended over it, half at the step and none in the middle between two steps. Next include of a pass that defines
// vec3 displayed(ivec2 pixel), which repeats the border.
#include "shared/luminance.glsl"

float brightness(ivec2 pixel) { return luminance(displayed(pixel)); }

// How far the pair of rows at an edge stays as bright as it is here: the distance in pixels of its end, and the pair's brightness there
// relative to that of the edge.
struct End {
    float away, change;
};
End end_of(ivec2 pixel, ivec2 along, ivec2 over, float edge_brightness, float least) {
    End end = End(float(reach), 0.0);
    for (int i = 1; i <= reach; ++i) {
        ivec2 at = pixel + i * along;
        end.change = 0.5 * (brightness(at) + brightness(at + over)) - edge_brightness;
        if (abs(end.change) >= least) {
            end.away = float(i);
            break;
        }
    }
    return end;
}

vec3 smoothed(ivec2 pixel) {
    float here = brightness(pixel), beside[9], low = here, high = here;
    for (int i = 0; i < 9; ++i) beside[i] = brightness(pixel + ivec2(i % 3, i / 3) - 1);
    for (int i = 1; i < 9; i += 2) low = min(low, beside[i]), high = max(high, beside[i]);
    if (high - low < max(edge_least, edge * high)) return displayed(pixel);
    float of_rows = 2.0 * abs(beside[1] + beside[7] - 2.0 * here) + abs(beside[0] + beside[6] - 2.0 * beside[3]) + abs(beside[2] + beside[8] - 2.0 * beside[5]),
          of_columns = 2.0 * abs(beside[3] + beside[5] - 2.0 * here) + abs(beside[0] + beside[2] - 2.0 * beside[1]) + abs(beside[6] + beside[8] - 2.0 * beside[7]);
    bool rows = of_rows >= of_columns;
    float before_it = rows ? beside[1] : beside[3], behind_it = rows ? beside[7] : beside[5];
    bool forward = abs(behind_it - here) > abs(before_it - here);
    int side = forward ? 1 : -1;
    ivec2 over = rows ? ivec2(0, side) : ivec2(side, 0), along = rows ? ivec2(1, 0) : ivec2(0, 1);
    float other = forward ? behind_it : before_it, middle = 0.5 * (here + other), least = 0.25 * abs(other - here);
    End back = end_of(pixel, -along, over, middle, least), front = end_of(pixel, along, over, middle, least);
    End nearer = back.away < front.away ? back : front;
    // The pair changes towards the brightness of the pixel's own side where the step is in the other row: then nothing is blended.
    if (nearer.change == 0.0 || (nearer.change > 0.0) == (here > middle)) return displayed(pixel);
    float part = max(0.5 - (nearer.away - 0.5) / (back.away + front.away - 1.0), 0.0);
    return mix(displayed(pixel), displayed(pixel + over), part);
}
