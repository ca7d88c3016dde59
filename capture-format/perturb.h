/* Perturbs values by half a step of the format in which the engine stored them, which is their rounding error. */
#ifndef GLINT_PERTURB_H
#define GLINT_PERTURB_H

#include "glint/capture.h"

/* The precision of a storage format. */
struct glint_precision {
    bool fixed;       /* all steps have one size; otherwise they are relative to the value */
    double half_step; /* fixed */
    int digits;       /* floating: bits behind the leading one */
    int lowest;       /* floating: the exponent below which steps are of one size */
    double low, high; /* values that it can hold */
    bool
        ends_stay; /* values at an end of the range, which engines write on purpose, do not move, and no value moves there */
    bool srgb;        /* steps are equal in sRGB-encoded values, while the file holds linear ones */
    double of_square; /* if not 0, half a step is this factor times the square of the value */
};
/* Of a channel by the name of the engine's format ("D24", "R11G11B10", "RG16F", "unorm8", "VK_FORMAT_R8G8B8A8_SRGB"); of
   one that is not known, as the file stores it. */
struct glint_precision glint_precision_of(const char *storage, const char *channel, enum glint_stored stored);
/* The precision of depth: where sky is, and for fixed-point depth that was decoded before the capture. */
struct glint_decoder;
void glint_precision_of_depth(struct glint_precision *precision, const struct glint_decoder *decoder);
/* The half step at a value. */
double glint_half_step(const struct glint_precision *precision, double value);

/* Which channels are perturbed, and how. */
struct glint_perturbation {
    uint32_t seed; /* 0: none */
    char (*only)[96];
    size_t only_count; /* 0: all */
};
bool glint_perturbation_moves(const struct glint_perturbation *p, const struct glint_part_info *part,
                              const char *channel);
/* The direction in which each pixel of a channel moves for a seed. In each group of eight seeds (1 to 8, 9 to 16, …) the first direction is
   random and the others follow by a Walsh function, so that half of them are up. The first seven perturbed channels of a part use different
   functions, so that over eight seeds the directions of any two channels are uncorrelated; further channels are random for each seed. */
struct glint_coins {
    uint64_t own, shared; /* keys: of the channel, of the part */
    uint32_t turn;        /* among the eight */
    uint32_t number;      /* of channels of the part that move and stand before this one */
};
struct glint_coins glint_perturbation_coins(const struct glint_perturbation *p, const struct glint_part_info *part,
                                            const char *channel);
double glint_perturbation_sign(const struct glint_coins *coins, uint64_t pixel);
/* Perturbs `count` stored values of the pixels from `first` on. 0 and values that are not finite do not change. */
void glint_perturb(const struct glint_precision *precision, const struct glint_coins *coins, uint64_t first, float *v,
                   size_t count);

#endif
