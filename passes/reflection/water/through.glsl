// Light on its way through water.
#ifndef GLINT_WATER_THROUGH
#define GLINT_WATER_THROUGH

// Length of the refracted ray to the bottom, if the view ray `towards` reaches the bottom after thickness_m: both descend equally deep.
float way_through(vec3 towards, float thickness_m, vec3 refracted) {
    float sinks = max(-dot(refracted, frame.up.xyz), 0.05);
    return thickness_m * max(-dot(towards, frame.up.xyz), 0.0) / sinks;
}

// The fraction of the light that is left after that way (Beer–Lambert); opacity: what a metre takes.
float left_after(float opacity, float way_m) { return pow(max(1.0 - opacity, 0.0), way_m); }
#endif
