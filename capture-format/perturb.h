/* Values that the engine may as well have had in mind: moved by half a step of the format that held them. */
#ifndef GLINT_PERTURB_H
#define GLINT_PERTURB_H

#include "glint/capture.h"

/* How finely a format holds values. */
struct glint_precision {
    bool fixed;       /* steps of one size, else of one part of the value */
    double half_step; /* fixed */
    int digits;       /* floating: bits behind the leading one */
    int lowest;       /* floating: the exponent below which steps are of one size */
    double low, high; /* values that it can hold */
    bool ends_stay;   /* nothing comes from an end of the range, which engines write on purpose, or gets there */
    bool srgb;        /* fixed in the curve's values, while the file holds linear ones */
    double of_square; /* not 0: half a step is this part of the value's square */
};
/* Of a channel by the name of the engine's format ("D24", "R11G11B10", "RG16F", "unorm8", "VK_FORMAT_R8G8B8A8_SRGB"); of
   one that is not known, as the file stores it. */
struct glint_precision glint_precision_of(const char *storage, const char *channel, enum glint_stored stored);
/* Of depth: where sky is, and fixed point that was decoded before it was captured. */
struct glint_decoder;
void glint_precision_of_depth(struct glint_precision *precision, const struct glint_decoder *decoder);
/* At a value. */
double glint_half_step(const struct glint_precision *precision, double value);

/* Which channels are moved, and how. */
struct glint_perturbation {
    uint32_t seed; /* 0: none are */
    char (*only)[96];
    size_t only_count; /* 0: all */
};
bool glint_perturbation_moves(const struct glint_perturbation *p, const struct glint_part_info *part,
                              const char *channel);
/* Up or down for each pixel of one channel of one part, as a seed has it. Of each eight seeds (1 to 8, 9 to 16, …) a coin says
   what the first one does, and the others follow by a Walsh function: half of them go up. Of the first seven channels of a part that
   move each pixel has another function for each, so that over eight seeds no two of them have anything in common; further
   channels have a coin for each seed. */
struct glint_coins {
    uint64_t own, shared; /* keys: of the channel, of the part */
    uint32_t turn;        /* among the eight */
    uint32_t number;      /* of channels of the part that move and stand before this one */
};
struct glint_coins glint_perturbation_coins(const struct glint_perturbation *p, const struct glint_part_info *part,
                                            const char *channel);
double glint_perturbation_sign(const struct glint_coins *coins, uint64_t pixel);
/* `count` values as stored, of pixels from `first`. Not finite and 0 stay as they are. */
void glint_perturb(const struct glint_precision *precision, const struct glint_coins *coins, uint64_t first, float *v,
                   size_t count);

#endif
