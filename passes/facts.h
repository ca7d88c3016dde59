/* The facts that rows NEEDS and FACT ask for, over the survey's figures. Rows only, read by C (replay/plan/facts.c):
   FACT(name, about, holds, the figure in words); FACT_BY where NEEDS_BY names a parameter, whose value is `limit`.
   Every answer is conservative: if a fact is false, there is no pixel for which the pass could do anything.
   s: the survey; shown: the pixels whose reflection is visible; share: their fraction of all pixels; faces: number of surveyed faces of
   active cube maps, 0 if they were not surveyed; open: number of these with a texel without a finite distance; translucent: number of these
   with a texel whose alpha lets the sky show. */
FACT(reflecting, PIXELS, shown->count > 0, SAY("%llu of %llu pixels reflect", N(shown->count), N(s->pixels)))
FACT(reflections, PIXELS, shown->count > 0 || s->has_transparent,
     SAY("%llu of %llu pixels reflect%s", N(shown->count), N(s->pixels), s->has_transparent ? ", and a transparent surface" : ""))
FACT_BY(sparse, PIXELS, share <= limit, SAY("%.3g %% of the pixels reflect, the limit is %.3g %%", 100 * share, 100 * limit))
FACT_BY(smooth, PIXELS, shown->count > 0 && shown->roughness[0] <= (float)limit, SAY_LIMIT("smoothest", 0, "at most"))
FACT_BY(rough, PIXELS, shown->count > 0 && shown->roughness[1] >= (float)limit, SAY_LIMIT("roughest", 1, "at least"))
/* The ray of a perfect mirror has no cone, so that only the finest MIP levels are sampled. */
FACT(cones, CONES, s->has_transparent || shown->roughness[1] > 0,
     s->has_transparent ? SAY("a transparent surface") : SAY_ROUGHNESS("roughest", 1))
FACT(surfaces, PIXELS, s->surfaces.count > 0, SAY("%llu of %llu pixels have a surface", N(s->surfaces.count), N(s->pixels)))
FACT(sky, PIXELS, s->sky > 0, SAY("%llu of %llu pixels are sky", N(s->sky), N(s->pixels)))
/* Whether a cube map has texels without a surface. */
FACT(cube_sky, FACES, open > 0 || faces == 0,
     faces ? SAY("%u of %u cube faces show the sky", open, faces) : SAY("the cube maps may show the sky"))
/* Whether a ray may end in the sky, or is seen through fog that takes the sky's colour. */
FACT(sky_seen, FACES_AND_PIXELS, s->sky > 0 || faces == 0 || open > 0 || translucent > 0 || s->has_fog,
     s->has_fog ? SAY("fog takes the colour of the sky")
     : faces    ? SAY("%llu pixels and %u of %u cube faces show the sky", N(s->sky), open > translucent ? open : translucent, faces)
     : s->sky   ? SAY("%llu pixels are sky", N(s->sky)) : SAY("the cube maps may show the sky"))
FACT(cubemaps, CUBEMAPS, s->cubemaps > 0, SAY("%u cube map%s", s->cubemaps, s->cubemaps == 1 ? "" : "s"))
FACT(distances, CUBEMAPS, s->distances > 0, SAY("%u of %u cube maps have distances", s->distances, s->cubemaps))
/* Whether rays that are traced in some cube maps may come to others that have no distances. */
FACT(some_distances, CUBEMAPS, s->distances > 0 && s->distances < s->cubemaps,
     SAY("%u of %u cube maps have distances", s->distances, s->cubemaps))
FACT(volumes, PARTS, s->volumes > 0, SAY("%u cube map%s with an inner volume", s->volumes, s->volumes == 1 ? "" : "s"))
FACT(probe, PARTS, s->has_probe, SAY("%s probe", s->has_probe ? "a" : "no"))
FACT(transparent, PARTS, s->has_transparent, SAY("%s transparent surface", s->has_transparent ? "a" : "no"))
FACT(water, PARTS, s->has_water, SAY("%s water surface", s->has_water ? "a" : "no"))
FACT(planar, PARTS, s->has_planar, SAY("%s planar reflection map", s->has_planar ? "a" : "no"))
FACT(fresnel, PARTS, s->has_fresnel, SAY("materials with%s a Fresnel factor", s->has_fresnel ? "" : "out"))
FACT(history, PARTS, s->has_history, SAY("%s", s->has_history ? "the previous frame is available" : "no previous frame, or a camera cut"))
FACT(stippled, PIXELS, s->has_stippling && s->stippled > 0,
     s->has_stippling ? SAY("%llu of %llu pixels show a stippled surface", N(s->stippled), N(s->pixels)) : SAY("no mask of stippled pixels"))
FACT(decals, PARTS, s->has_overlays, SAY("%s", s->has_overlays ? "decal buffers" : "no decal buffers"))
FACT(skin, PIXELS, s->has_skin && s->skin > 0,
     s->has_skin ? SAY("%llu of %llu pixels show skin", N(s->skin), N(s->pixels)) : SAY("no mask and no stencil class of skin"))
FACT(fog, PARTS, s->has_fog || s->has_froxels, SAY("%s", s->has_fog ? "fog" : s->has_froxels ? "light in the air" : "no fog"))
FACT(froxels, PARTS, s->has_froxels, SAY("%s", s->has_froxels ? "light in the air, in slices" : "no slices of light in the air"))
FACT(shafts, PARTS, s->has_fog && s->has_sun && s->has_shadows,
     SAY("%s", !s->has_fog ? "no fog" : !s->has_sun ? "no sun" : s->has_shadows ? "fog, a sun and its shadow map" : "no shadow map"))
FACT(atmosphere, PARTS, s->has_atmosphere, SAY("%s atmosphere", s->has_atmosphere ? "an" : "no"))
FACT(clouds, PARTS, s->has_clouds, SAY("%s", s->has_clouds ? "clouds" : "no clouds"))
FACT(drawn_sky, PARTS, s->has_atmosphere || s->has_clouds,
     SAY("%s", s->has_atmosphere ? "an atmosphere" : s->has_clouds ? "clouds" : "no atmosphere and no clouds"))
FACT(indirect_light, PARTS, s->has_indirect, SAY("%s part of the light that is indirect", s->has_indirect ? "a" : "no"))
/* Whether surfaces can receive light from others or the sky: where nothing is lit, only what other parts than the picture hold. */
#define OTHER_LIGHT                                                                                                             \
    (s->cubemaps > 0 || s->has_sky || s->has_probe || s->has_volume || s->has_indirect || s->has_earlier_lit || s->has_earlier_scene || s->has_history)
FACT(bounce, PIXELS,
     s->surfaces.count > 0 && (s->luminous > 0 || OTHER_LIGHT),
     s->surfaces.count == 0 ? SAY("%llu of %llu pixels have a surface", N(s->surfaces.count), N(s->pixels))
     : s->luminous > 0      ? SAY("%llu of %llu pixels are not black", N(s->luminous), N(s->pixels))
                            : SAY("the picture is black, and there %s other light", OTHER_LIGHT ? "may be" : "is no"))
/* Whether a pixel of the picture, as it is displayed, may be brighter than the limit. How bright reflections, indirect light, lamps, sky, fog, surfaces in
   front and earlier frames make it is not known beforehand, so that frames with any of them count. The factor is for rounding. */
#define BRIGHTEST (s->exposure * (double)s->light[1])
#define MORE_LIGHT                                                                                                              \
    (shown->count > 0 || s->has_transparent || s->has_water || s->has_scene || s->has_history || s->has_fog || s->has_froxels || s->has_atmosphere || \
     s->has_clouds || s->lamps > 0 || (s->surfaces.count > 0 && OTHER_LIGHT))
FACT_BY(bright, PIXELS, 1.00001 * BRIGHTEST > limit || MORE_LIGHT,
        BRIGHTEST > 3e38 ? SAY("the picture may be brighter than %.3g", limit)
                         : SAY("the brightest of the lit picture is %.3g, the limit %.3g%s", BRIGHTEST, limit,
                               1.00001 * BRIGHTEST > limit ? "" : MORE_LIGHT ? "; other light may be added" : "; nothing is added"))
#undef MORE_LIGHT
#undef BRIGHTEST
#undef OTHER_LIGHT
/* Whether lamps light surfaces, or do in the captured picture; the limit is 0 where their light does not end. */
#define LAMPLIT s->lamps ? SAY("light of %u lamp%s may reach %llu of %llu surfaces", s->lamps, s->lamps == 1 ? "" : "s", N(s->lamplit), N(s->surfaces.count)) : SAY("no lamps")
FACT(lamplit, PIXELS, s->lamps > 0 && s->lamplit > 0, LAMPLIT)
FACT_BY(lamplit_within, PIXELS, s->lamps > 0 && (s->lamplit > 0 || limit == 0), LAMPLIT)
#undef LAMPLIT
FACT(lamps, PARTS, s->lamps > 0 && s->has_lamps, SAY("%s, %s part of the light that is theirs", s->lamps > 0 ? "lamps" : "no lamps", s->has_lamps ? "a" : "no"))
FACT(light_volume, PARTS, s->has_volume, SAY("%s volume of light", s->has_volume ? "a" : "no"))
FACT(no_light_volume, PARTS, !s->has_volume, SAY("%s volume of light", s->has_volume ? "a" : "no"))
FACT(sun, PARTS, s->has_sun, SAY("%s sun", s->has_sun ? "a" : "no"))
/* Whether contact shadows can take light away: surfaces that the captured mask leaves in the sun. */
FACT(sunlit, PIXELS, s->has_sun && s->sunlit > 0,
     s->has_sun ? SAY("%llu of %llu surfaces are not in the shadow of the sun's mask", N(s->sunlit), N(s->surfaces.count)) : SAY("no sun"))
