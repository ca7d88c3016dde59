// Diffuse light alone, and the distance from the eye in alpha: what `lit` and cube maps hold. A material plugin, so that textures,
// bones, instances and alpha tests stay the material's own. It changes nothing but in the render passes given to it.
import {MaterialPluginBase} from "@babylonjs/core/Materials/materialPluginBase.js";

const PBR = `
#if defined(GLINT_DIFFUSE) && !defined(UNLIT)
#ifdef SPECULARTERM
finalSpecularScaled = vec3(0.);
#endif
#ifdef SHEEN
finalSheenScaled = vec3(0.);
#endif
#ifdef CLEARCOAT
finalClearCoatScaled = vec3(0.);
#endif
#ifdef REFLECTION
finalRadianceScaled = vec3(0.);
#if defined(SHEEN) && defined(ENVIRONMENTBRDF)
sheenOut.finalSheenRadianceScaled = vec3(0.);
#endif
#ifdef CLEARCOAT
clearcoatOut.finalClearCoatRadianceScaled = vec3(0.);
#endif
#endif
#endif
`;

// The standard material's own sum, once more without its two specular terms.
const STANDARD = `
#ifdef GLINT_DIFFUSE
color.rgb = finalDiffuse * baseAmbientColor + refractionColor.rgb;
#ifdef EMISSIVEASILLUMINATION
color.rgb = clamp(color.rgb + emissiveColor, 0., 1.);
#endif
#if defined(LIGHTMAP) && !defined(LIGHTMAPEXCLUDED)
#ifdef USELIGHTMAPASSHADOWMAP
color.rgb *= lightmapColor.rgb;
#else
color.rgb += lightmapColor.rgb;
#endif
#endif
#endif
`;

const far = (color) => `
#ifdef GLINT_DIFFUSE
${color}.a = distance(vPositionW, vEyePosition.xyz);
#endif
`;

const CODE = {
    pbr: {CUSTOM_FRAGMENT_BEFORE_FINALCOLORCOMPOSITION: PBR, CUSTOM_FRAGMENT_BEFORE_FRAGCOLOR: far("finalColor")},
    standard: {CUSTOM_FRAGMENT_BEFORE_FOG: STANDARD, CUSTOM_FRAGMENT_BEFORE_FRAGCOLOR: far("color")},
};

const CLASSES = {
    PBRMaterial: "pbr", PBRMetallicRoughnessMaterial: "pbr", PBRSpecularGlossinessMaterial: "pbr", StandardMaterial: "standard",
};

export const kindOf = (material) => CLASSES[material.getClassName()];

const NAME = "GlintDiffuse";

class DiffusePlugin extends MaterialPluginBase {
    constructor(material) {
        super(material, NAME, 900, {GLINT_DIFFUSE: false});
        this.passes = new Set();
        this._enable(true);
    }

    getClassName() {
        return "GlintDiffusePlugin";
    }

    prepareDefines(defines, scene) {
        defines.GLINT_DIFFUSE = this.passes.has(scene.getEngine().currentRenderPassId);
        if (!defines.GLINT_DIFFUSE) return;
        // These passes have one target, whatever the pre-pass renderer asks for.
        defines.PREPASS = false;
        defines.SCENE_MRT_COUNT = 0;
    }

    getCustomCode(shader) {
        return shader === "fragment" ? CODE[kindOf(this._material)] : null;
    }
}

// Gives the materials a plugin, once, and says in which render passes they are diffuse.
export function makeDiffuse(materials, passIds) {
    for (const material of materials) {
        const plugin = material.pluginManager?.getPlugin(NAME) ?? new DiffusePlugin(material);
        plugin.passes = new Set(passIds);
        plugin.markAllDefinesAsDirty();
    }
}
