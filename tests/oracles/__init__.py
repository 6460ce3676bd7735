"""Independent calculations, plain and slow, of what the programs in ``asm/`` must yield."""
