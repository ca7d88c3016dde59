#include "air.h"

static void read_color(const struct node *node, const char *key, float out[3]) {
    double color[3] = {0};
    node_numbers(node, key, color);
    for (int i = 0; i < 3; i++) out[i] = (float)color[i];
}

static void read_atmosphere(const struct node *node, struct glint_atmosphere *air) {
    read_color(node, "irradiance", air->irradiance);
    read_color(node, "rayleigh", air->rayleigh);
    air->planet_radius = node_number(node, "planet_radius", 0);
    air->ground = node_number(node, "ground", 0);
    air->top = node_number(node, "top", 0);
    air->rayleigh_height = node_number(node, "rayleigh_height", 8000);
    air->mie = node_number(node, "mie_scattering", 0);
    air->mie_extinction = node_number(node, "mie_extinction", 0);
    air->mie_height = node_number(node, "mie_height", 1200);
    air->mie_asymmetry = node_number(node, "mie_asymmetry", 0);
}

static void read_clouds(const struct node *node, struct glint_clouds *clouds) {
    clouds->ground = node_number(node, "ground", 0);
    clouds->bottom = node_number(node, "bottom", 0);
    clouds->top = node_number(node, "top", 0);
    clouds->tile = node_number(node, "tile", 0);
    clouds->noise_tile = node_number(node, "noise_tile", 1000);
    clouds->extinction = node_number(node, "extinction", 0);
    clouds->erosion = node_number(node, "erosion", 0);
    node_numbers(node, "offset", clouds->offset);
}

void air_read(const struct node *frame_node, struct glint_frame *frame) {
    const struct node atmosphere = node_child(frame_node, "atmosphere"), clouds = node_child(frame_node, "clouds");
    frame->has_atmosphere = atmosphere.value != NULL;
    frame->has_clouds = clouds.value != NULL;
    if (atmosphere.value) read_atmosphere(&atmosphere, &frame->atmosphere);
    if (clouds.value) read_clouds(&clouds, &frame->clouds);
}
