/* Loads meshes and the first camera of glTF 2 files through Assimp. */
#include "gltf.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <string.h>

#include "gltf_check.h"
#include "gltf_material.h"
#include "texture.h"

enum { MAX_DEPTH = 64, MAX_TRIANGLES = 20000000, VERTEX_BUDGET = 300000 };

static vec3 daylight(vec3 d) {
    vec3 horizon = v3(0.9f, 0.92f, 0.95f), zenith = v3(0.25f, 0.42f, 0.78f), ground = v3(0.22f, 0.2f, 0.18f);
    return d.y > 0 ? mix(horizon, zenith, sqrtf(d.y)) : mix(horizon, ground, smooth(0, 0.1f, -d.y));
}

static vec3 transformed(const struct aiMatrix4x4 *m, struct aiVector3D p, float w) {
    return v3(m->a1 * p.x + m->a2 * p.y + m->a3 * p.z + m->a4 * w, m->b1 * p.x + m->b2 * p.y + m->b3 * p.z + m->b4 * w,
              m->c1 * p.x + m->c2 * p.y + m->c3 * p.z + m->c4 * w);
}

/* Normals are transformed by the cofactor matrix, which is also correct for mirroring and non-uniform scale. */
static vec3 turned_normal(const struct aiMatrix4x4 *m, struct aiVector3D n) {
    vec3 x = v3(m->a1, m->b1, m->c1), y = v3(m->a2, m->b2, m->c2), z = v3(m->a3, m->b3, m->c3);
    vec3 sum = add(add(scale(cross(y, z), n.x), scale(cross(z, x), n.y)), scale(cross(x, y), n.z));
    vec3 normal = unit(dot(cross(x, y), z) < 0 ? scale(sum, -1) : sum);
    return length(normal) > 0.5f ? normal
                                 : v3(0, 1, 0); /* a file's may be 0 or no numbers, of which Embree makes no rays */
}

struct corner {
    vec3 position, normal;
    struct skin skin;
};

static struct skin skin_between(const struct corner c[3], float w, float u, float v) {
    const struct skin *a = &c[0].skin, *b = &c[1].skin, *d = &c[2].skin;
    return (struct skin){.u = w * a->u + u * b->u + v * d->u,
                         .v = w * a->v + u * b->v + v * d->v,
                         .color = along(along(scale(a->color, w), b->color, u), d->color, v),
                         .alpha = w * a->alpha + u * b->alpha + v * d->alpha,
                         .tangent = along(along(scale(a->tangent, w), b->tangent, u), d->tangent, v),
                         .bitangent = along(along(scale(a->bitangent, w), b->bitangent, u), d->bitangent, v)};
}

/* Subdivides a triangle, because baked light is stored at vertices. */
static void add_divided(struct scene *scene, const struct corner c[3], uint32_t n) {
    uint32_t row = 0;
    for (uint32_t j = 0; j <= n; j++) {
        uint32_t before = row;
        for (uint32_t i = 0; i + j <= n; i++) {
            float v = (float)j / (float)n, u = (float)i / (float)n, w = 1 - u - v;
            vec3 p = add(add(scale(c[0].position, w), scale(c[1].position, u)), scale(c[2].position, v));
            vec3 normal = unit(add(add(scale(c[0].normal, w), scale(c[1].normal, u)), scale(c[2].normal, v)));
            struct skin skin = skin_between(c, w, u, v);
            uint32_t index = scene_vertex(scene, p, normal);
            scene_skin(scene, &skin);
            if (!i) row = index;
        }
        for (uint32_t i = 0; j && i + j <= n; i++) {
            scene_triangle(scene, before + i, before + i + 1, row + i);
            if (i + j < n) scene_triangle(scene, before + i + 1, row + i + 1, row + i);
        }
    }
}

static uint32_t divisions(const struct scene *scene, const struct corner c[3]) {
    float longest = 0;
    for (int i = 0; i < 3; i++) longest = fmaxf(longest, length(sub(c[(i + 1) % 3].position, c[i].position)));
    float n = ceilf(longest / scene->cell);
    return n < 1 ? 1 : n > 100 ? 100 : (uint32_t)n;
}

struct reading {
    const struct aiScene *file;
    struct scene *scene; /* NULL: measure only */
    const char *path;
    vec3 low, high;
    float cell;
    size_t vertices; /* number of vertices after subdivision by `cell` */
    size_t triangles;
    bool bad;
    struct glint_error *err;
    bool failed; /* and the error is set */
};

static void visit_triangle(struct reading *r, const struct corner c[3]) {
    for (int i = 0; i < 3; i++) {
        vec3 p = c[i].position;
        if (!(fabsf(p.x) < 1e6f && fabsf(p.y) < 1e6f && fabsf(p.z) < 1e6f)) r->bad = true;
        r->low = v3(fminf(r->low.x, p.x), fminf(r->low.y, p.y), fminf(r->low.z, p.z));
        r->high = v3(fmaxf(r->high.x, p.x), fmaxf(r->high.y, p.y), fmaxf(r->high.z, p.z));
    }
    struct scene measure = {.cell = r->cell};
    size_t n = r->cell > 0 ? divisions(&measure, c) : 1;
    r->vertices += (n + 1) * (n + 2) / 2;
    r->triangles++;
    if (r->scene) add_divided(r->scene, c, (uint32_t)n);
}

/* Invalid texture coordinates become 0. */
static float coordinate(float value) {
    return fabsf(value) < 1e6f ? value : 0;
}

static struct skin skin_of(const struct aiMesh *mesh, unsigned i, const struct aiMatrix4x4 *m) {
    struct skin skin = {.color = gray(1), .alpha = 1};
    if (mesh->mTextureCoords[0]) {
        skin.u = coordinate(mesh->mTextureCoords[0][i].x);
        skin.v = 1 - coordinate(mesh->mTextureCoords[0][i].y); /* Assimp flips images vertically */
    }
    if (mesh->mColors[0]) {
        const struct aiColor4D *c = &mesh->mColors[0][i];
        skin.color = v3(clampf(c->r, 0, 1), clampf(c->g, 0, 1), clampf(c->b, 0, 1));
        skin.alpha = clampf(c->a, 0, 1);
    }
    if (mesh->mTangents && mesh->mBitangents) {
        vec3 t = unit(transformed(m, mesh->mTangents[i], 0)), b = unit(transformed(m, mesh->mBitangents[i], 0));
        /* if a triangle has no extent in uv, the mesh's own normal stays */
        if (length(t) > 0.5f && length(b) > 0.5f) {
            skin.tangent = t;
            skin.bitangent = b;
        }
    }
    return skin;
}

static void visit_mesh(struct reading *r, const struct aiMesh *mesh, const struct aiMatrix4x4 *m) {
    if (!(mesh->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) || !mesh->mNormals) return;
    if (r->scene) {
        struct material material;
        if (r->failed) return;
        if (!gltf_material(r->file, r->file->mMaterials[mesh->mMaterialIndex], r->path, r->scene, &material, r->err)) {
            r->failed = true;
            return;
        }
        scene_mesh(r->scene, &material, MESH_PLAIN);
    }
    for (unsigned f = 0; f < mesh->mNumFaces; f++) {
        struct corner c[3];
        if (mesh->mFaces[f].mNumIndices != 3) continue;
        for (int i = 0; i < 3; i++) {
            unsigned index = mesh->mFaces[f].mIndices[i];
            c[i].position = transformed(m, mesh->mVertices[index], 1);
            c[i].normal = turned_normal(m, mesh->mNormals[index]);
            if (r->scene) c[i].skin = skin_of(mesh, index, m);
        }
        visit_triangle(r, c);
    }
}

static void visit_node(struct reading *r, const struct aiNode *node, struct aiMatrix4x4 m, int depth) {
    if (r->triangles > MAX_TRIANGLES) return; /* however often nodes repeat a mesh */
    if (depth > MAX_DEPTH) {
        r->bad = true;
        return;
    }
    aiMultiplyMatrix4(&m, &node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes && r->triangles <= MAX_TRIANGLES; i++)
        visit_mesh(r, r->file->mMeshes[node->mMeshes[i]], &m);
    for (unsigned i = 0; i < node->mNumChildren; i++) visit_node(r, node->mChildren[i], m, depth + 1);
}

static void visit(struct reading *r) {
    struct aiMatrix4x4 identity;
    aiIdentityMatrix4(&identity);
    r->low = gray(INFINITY);
    r->high = gray(-INFINITY);
    r->vertices = r->triangles = 0;
    visit_node(r, r->file->mRootNode, identity, 0);
}

static const struct aiNode *find_node(const struct aiNode *node, const struct aiString *name, struct aiMatrix4x4 parent,
                                      struct aiMatrix4x4 *world, int depth) {
    if (depth > MAX_DEPTH) return NULL;
    aiMultiplyMatrix4(&parent, &node->mTransformation);
    if (!strcmp(node->mName.data, name->data)) {
        *world = parent;
        return node;
    }
    for (unsigned i = 0; i < node->mNumChildren; i++) {
        const struct aiNode *found = find_node(node->mChildren[i], name, parent, world, depth + 1);
        if (found) return found;
    }
    return NULL;
}

static bool file_camera(const struct aiScene *file, const struct gltf_facts *facts, struct scene *scene) {
    struct aiMatrix4x4 identity, m;
    aiIdentityMatrix4(&identity);
    if (!file->mNumCameras) return false;
    const struct aiCamera *camera = file->mCameras[0];
    if (!find_node(file->mRootNode, &camera->mName, identity, &m, 0)) return false;
    /* glTF cameras are at the origin of their node; Assimp 5.2 also adds the node's translation to mPosition */
    vec3 eye = transformed(&m, (struct aiVector3D){0, 0, 0}, 1), ahead = unit(transformed(&m, camera->mLookAt, 0));
    if (!(length(ahead) > 0.5f) || !(length(eye) < 1e6f)) return false;
    scene->eye = eye;
    scene->target = add(eye, ahead);
    if (facts->fov_y_rad > 0.01 && facts->fov_y_rad < 2.8) scene->fov_y_rad = (float)facts->fov_y_rad;
    return true;
}

static void set_stage(const struct aiScene *file, const struct gltf_facts *facts, struct scene *scene, vec3 low,
                      vec3 high) {
    vec3 middle = scale(add(low, high), 0.5f);
    float radius = fmaxf(0.5f * length(sub(high, low)), 1e-3f);
    scene->sky = daylight;
    scene->sun_direction = unit(v3(0.45f, 0.8f, 0.35f));
    scene->sun_irradiance = v3(3, 2.8f, 2.5f);
    scene->light_samples = 64;
    scene->bounces = 1;
    scene->probes = GLINT_PROBES_AUTO;
    scene->fov_y_rad = 0.9f;
    if (!file_camera(file, facts, scene)) {
        scene->eye = along(middle, unit(v3(0.6f, 0.35f, 1)), 1.05f * radius / sinf(0.45f));
        scene->target = middle;
    }
    scene->eye_step = scale(unit(cross(sub(scene->target, scene->eye), v3(0, 1, 0))), 0.004f * radius);
    scene->player = scene->eye;
    scene->player_step = scene->eye_step;
}

static bool take_over(struct reading *r, const struct gltf_facts *facts, struct scene *scene, struct glint_error *err) {
    visit(r);
    if (!r->triangles) return glint_fail(err, GLINT_ERROR_FORMAT, "%s: no triangles", r->path);
    if (r->bad)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected positions within 1,000 km and at most %d nested nodes",
                          r->path, MAX_DEPTH);
    if (r->triangles > MAX_TRIANGLES)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s: more than %d triangles", r->path, MAX_TRIANGLES);
    r->cell = fmaxf(length(sub(r->high, r->low)) / 100, 1e-6f);
    for (visit(r); r->vertices > VERTEX_BUDGET + 3 * r->triangles; visit(r)) r->cell *= 1.5f;
    set_stage(r->file, facts, scene, r->low, r->high);
    r->scene = scene;
    scene->cell = r->cell;
    visit(r);
    if (r->failed) return false;
    return !scene->out_of_memory || glint_fail(err, GLINT_ERROR_MEMORY, "%s: no memory for its meshes", r->path);
}

/* The importer silently drops faces with missing vertices. */
static bool check_triangle_count(const struct aiScene *file, uint64_t promised, const char *path,
                                 struct glint_error *err) {
    uint64_t there = 0;
    for (unsigned m = 0; m < file->mNumMeshes; m++) {
        const struct aiMesh *mesh = file->mMeshes[m];
        for (unsigned f = 0; f < mesh->mNumFaces; f++) {
            const struct aiFace *face = &mesh->mFaces[f];
            bool whole = face->mNumIndices == 3;
            for (unsigned i = 0; i < face->mNumIndices; i++) whole = whole && face->mIndices[i] < mesh->mNumVertices;
            there += whole;
        }
    }
    return there >= promised ||
           glint_fail(err, GLINT_ERROR_FORMAT, "%s: %llu of %llu triangles refer to vertices that are not there", path,
                      (unsigned long long)(promised - there), (unsigned long long)promised);
}

bool gltf_load(const char *path, struct scene *scene, struct glint_error *err) {
    struct gltf_facts facts;
    if (!gltf_check(path, &facts, err)) return false;
    const struct aiScene *file =
        aiImportFile(path, aiProcess_Triangulate | aiProcess_GenNormals | aiProcess_CalcTangentSpace |
                               aiProcess_SortByPType | aiProcess_ValidateDataStructure);
    if (!file || !file->mRootNode) {
        const char *reason = aiGetErrorString();
        glint_fail(err, GLINT_ERROR_FORMAT, "%s: %s", path, reason && *reason ? reason : "not a glTF scene");
        if (file) aiReleaseImport(file);
        return false;
    }
    struct reading reading = {.file = file, .path = path, .err = err};
    bool ok = check_triangle_count(file, facts.triangles, path, err) && take_over(&reading, &facts, scene, err);
    aiReleaseImport(file);
    return ok;
}
