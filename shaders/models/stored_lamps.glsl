// Lamps beside a grain of which it is stored what they do in it (native/render/stored_lamps.h).
#ifdef STORED_LAMPS
uniform sampler3D lamp_sources;  // the source function of each, over the lamp's strength: blocks of nodes behind one another
uniform int stored_lamps;        // a bit for each light that has a place

int lamp_block = -1;  // of the one that is asked about; negative: it is not stored

void look_for_lamp(int light) {
  bool known = light < 31 && (stored_lamps >> light & 1) != 0;
  lamp_block = known ? bitCount(stored_lamps & ((1 << light) - 1)) : -1;
}
#endif
