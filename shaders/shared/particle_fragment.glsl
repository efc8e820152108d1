// Inputs, output and a function of all fragment stages of particles. A stage declares only the other
// inputs that it reads (shared/particle_vertex.glsl has all): a CPU driver spends time on each
// declared input of each spot, read or not. GLSL only.
layout(location = 0) in vec2 place;
layout(location = 1) flat in vec3 shape;

layout(location = 0) out vec4 out_color;

// The way from the streak's nearest point, in pixels.
vec2 from_streak() { return vec2(max(abs(place.x) - shape.x, 0.0) * sign(place.x), place.y); }
