/* Where the rays of opaque surfaces ended. */
#line 252
READ(utexture2D, screen_finished)
READ(texture2D, travelled)
READ(utexture2D, cubemap_index)
