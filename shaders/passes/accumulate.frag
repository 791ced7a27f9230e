// Hands one sample to the blender, which adds it to the sum.

uniform sampler2D image;

out vec4 colour;

void main() { colour = texelFetch(image, ivec2(gl_FragCoord.xy), 0); }
