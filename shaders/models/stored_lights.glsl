// Lights over a grain of which it is stored what each does in it, lamps and suns (native/render/stored_lights.h).
#ifdef STORED_LIGHTS
uniform sampler3D light_sources;  // the source function of each, over the light's strength: blocks of nodes behind one another, lamps' first
uniform int stored_lamps;         // a bit for each light that has a place
uniform int stored_suns;          // and for each sun

int light_block = -1;  // of the one that is asked about; negative: it is not stored

int block_among(int stored, int light) { return light < 31 && (stored >> light & 1) != 0 ? bitCount(stored & ((1 << light) - 1)) : -1; }

void look_for_lamp(int light) { light_block = block_among(stored_lamps, light); }

void look_for_sun(int light) {
  int block = block_among(stored_suns, light);
  light_block = block < 0 ? block : bitCount(stored_lamps) + block;
}
#endif
