/* Colour maps of false-colour images. */
#include "draw/view/colormap.h"

/* Viridis (Smith and van der Walt, 2015, CC0) by Matt Zucker's polynomial of degree six (2019, CC0,
   shadertoy.com/view/WlfXRN), which is within 1/255 of the table except at both ends. */
struct rgb colormap_viridis(double t) {
    static const double c[7][3] = {
        {0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
        {0.1050930431085774, 1.404613529898575, 1.384590162594685},
        {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
        {-4.634230498983486, -5.799100973351585, -19.33244095627987},
        {6.228269936347081, 14.17993336680509, 56.69055260068105},
        {4.776384997670288, -13.74514537774601, -65.35303263337234},
        {-5.435455855934631, 4.645852612178535, 26.3124352495832},
    };
    double v[3];
    t = t > 0 ? t < 1 ? t : 1 : 0;
    for (int k = 0; k < 3; k++) {
        v[k] = 0;
        for (int i = 6; i >= 0; i--) v[k] = v[k] * t + c[i][k];
        v[k] = v[k] > 0 ? v[k] < 1 ? v[k] : 1 : 0;
    }
    return (struct rgb){(uint8_t)(v[0] * 255 + 0.5), (uint8_t)(v[1] * 255 + 0.5), (uint8_t)(v[2] * 255 + 0.5)};
}

struct rgb colormap_category(uint32_t index) {
    static const struct rgb palette[11] = {
        {0x3a, 0x3f, 0x47}, {0x59, 0xa1, 0x4f}, {0xf2, 0x8e, 0x2b}, {0xe1, 0x57, 0x59},
        {0x4e, 0x79, 0xa7}, {0xed, 0xc9, 0x48}, {0xb0, 0x7a, 0xa1}, {0x76, 0xb7, 0xb2},
        {0xff, 0x9d, 0xa7}, {0x9c, 0x75, 0x5f}, {0xba, 0xb0, 0xac},
    };
    if (index == 0) return palette[0];
    struct rgb c = palette[1 + (index - 1) % 10];
    /* each repetition of the palette is darker */
    uint32_t round = (index - 1) / 10 % 3;
    return (struct rgb){(uint8_t)(c.r * (4 - round) / 4), (uint8_t)(c.g * (4 - round) / 4),
                        (uint8_t)(c.b * (4 - round) / 4)};
}
