"""Programs for the graphics card (or llvmpipe): textured ground and robot, lit by one sun, with haze far away.

All but texture and haze is done per vertex: pixels are what software drawing pays for.
"""

_VERTEX_LIGHT = """
#version 330
const vec3 SUN = vec3(0.358, 0.268, 0.894);
uniform mat4 clip_from_world;
uniform float colour;
uniform vec3 tints[8];
out vec3 light;
out vec3 texture_coordinate;

void lit(vec3 position, vec3 normal, vec2 texture_position, float layer) {
    gl_Position = clip_from_world * vec4(position, 1.0);
    float shade = 0.50 + 0.55 * max(dot(normalize(normal), SUN), 0.0);
    light = shade * mix(vec3(1.0), tints[int(layer + 0.5)], colour);
    texture_coordinate = vec3(texture_position, layer);
}
"""

GROUND_VERTEX = (
    _VERTEX_LIGHT
    + """
in vec3 position;
in vec3 normal;
in vec2 texture_position;
in float layer;

void main() {
    lit(position, normal, texture_position, layer);
}
"""
)

ROBOT_VERTEX = (
    _VERTEX_LIGHT
    + """
uniform float robot_layer;
in vec3 position;
in vec3 normal;
in mat4 world_from_shape;

void main() {
    mat3 turn = mat3(world_from_shape);
    vec3 scale = vec3(length(turn[0]), length(turn[1]), length(turn[2]));
    vec3 size = position * scale;
    vec4 placed = world_from_shape * vec4(position, 1.0);
    lit(placed.xyz, turn * (normal / (scale * scale)), size.xy + size.z, robot_layer);
}
"""
)

FRAGMENT = """
#version 330
uniform sampler2DArray textures;
uniform vec3 sky;
in vec3 light;
in vec3 texture_coordinate;
out vec4 pixel;

void main() {
    float haze = smoothstep(12.0, 55.0, 1.0 / gl_FragCoord.w);
    pixel = vec4(mix(texture(textures, texture_coordinate).r * light, sky, haze), 1.0);
}
"""
