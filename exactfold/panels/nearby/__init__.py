"""What holds for every sheet near a drawing: the sheet that was meant is among them."""
